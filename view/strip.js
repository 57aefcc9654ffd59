// SPDX-License-Identifier: MIT
// Poses side by side, each with its time: what #still&strip=t1,t2,... shows instead of one scene.
function drawStrip(scene, canvas, times, dark) {
  const out = document.createElement('canvas'), main = canvas.parentNode, d = out.getContext('2d');
  out.style.width = '100%'; out.style.height = '100%';
  canvas.replaceWith(out);
  const draw = () => {
    const ratio = window.devicePixelRatio || 1, W = out.width = Math.round(main.clientWidth * ratio), H = out.height = Math.round(main.clientHeight * ratio), wide = Math.floor(W / times.length);
    canvas.width = wide; canvas.height = H;
    times.forEach((t, k) => {
      scene.draw(t, false, 1e-9, dark(), -1);
      d.drawImage(canvas, k * wide, 0);
      d.fillStyle = dark() ? '#e8e6e1' : '#23262b'; d.font = `${Math.round(H / 20)}px system-ui, sans-serif`; d.textAlign = 'center';
      d.fillText(`t = ${say(t)} s`, (k + 0.5) * wide, H - H / 30);
      if (k) d.fillRect(k * wide, 0, 1, H);
    });
  };
  addEventListener('resize', draw);
  draw();
}
