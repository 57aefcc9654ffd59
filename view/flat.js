// SPDX-License-Identifier: MIT
// A flat panel of a figure: axes, lines, points, arrows, texts, marks.
function axisOf(panel, axis, name, steps, tight) {
  const asked = panel[name + 'range'], log = panel[name + 'log'];
  let [low, high] = asked || extentOf(panel, axis, log) || [0, 1];
  if (log) {
    low = Math.floor(Math.log10(low > 0 ? low : 1e-10) + 1e-9); high = Math.max(Math.ceil(Math.log10(high > 0 ? high : 1) - 1e-9), low + 1);
    const every = high - low > 10 ? 2 : 1;
    return { low, high, log, ticks: ticksOf(low, high, every), of: x => (x > 0 ? Math.log10(x) : NaN), say: k => '10' + [...String(k)].map(c => '⁰¹²³⁴⁵⁶⁷⁸⁹'[c] || '⁻').join('') };
  }
  const margin = 1e-9 * Math.max(Math.abs(low), Math.abs(high));
  if (high - low <= margin) { low -= Math.max(margin, 0.5); high += Math.max(margin, 0.5); }
  const step = niceStep(high - low, steps);
  if (!asked && !tight) { low = Math.floor(low / step + 1e-9) * step; high = Math.ceil(high / step - 1e-9) * step; }
  return { low, high, ticks: ticksOf(low, high, step), of: x => x, say: x => String(+x.toPrecision(6)) };
}
function drawShape(d, shape, x, y, r) {
  d.beginPath();
  if (shape === 'square') { d.rect(x - r, y - r, 2 * r, 2 * r); d.fill(); }
  else if (shape === 'triangle') { d.moveTo(x, y - r); d.lineTo(x + r, y + r); d.lineTo(x - r, y + r); d.closePath(); d.fill(); }
  else if (shape === 'cross' || shape === 'star') {
    d.lineWidth = 1.5;
    [[1, 1], [1, -1], ...(shape === 'star' ? [[1, 0], [0, 1]] : [])].forEach(([a, b]) => { d.moveTo(x - a * r, y - b * r); d.lineTo(x + a * r, y + b * r); });
    d.stroke();
  } else { d.arc(x, y, r, 0, 7); if (shape === 'circle') { d.lineWidth = 1.5; d.stroke(); } else d.fill(); }
}
function drawArrow(d, x, y, u, v, head) {
  const length = Math.hypot(u - x, v - y), a = Math.atan2(v - y, u - x), h = head === 0 ? 0 : Math.min(10, 0.4 * length);
  d.beginPath(); d.moveTo(x, y); d.lineTo(u, v); d.stroke();
  if (!h) return;
  d.beginPath(); d.moveTo(u, v); d.lineTo(u - h * Math.cos(a - 0.35), v - h * Math.sin(a - 0.35)); d.lineTo(u - h * Math.cos(a + 0.35), v - h * Math.sin(a + 0.35)); d.closePath(); d.fill();
}
function drawFlat(d, panel, place) {
  const items = colored(panel), framed = panel.frame !== false;
  let box = place.exact ? { ...place } : { x: place.x + 78, y: place.y + 32, w: place.w - 104, h: place.h - 88 };
  const X = axisOf(panel, 0, 'x', panel.equal ? 5 : 7, !panel.equal), Y = axisOf(panel, 1, 'y', 5, false);
  if (panel.equal) {
    const scale = Math.min(box.w / (X.high - X.low), box.h / (Y.high - Y.low)), w = scale * (X.high - X.low), h = scale * (Y.high - Y.low);
    box = { x: box.x + (box.w - w) / 2, y: box.y + (box.h - h) / 2, w, h };
  }
  const px = x => (real(x) ? box.x + box.w * (X.of(x) - X.low) / (X.high - X.low) : NaN), py = y => (real(y) ? box.y + box.h * (1 - (Y.of(y) - Y.low) / (Y.high - Y.low)) : NaN);
  if (panel.title) letter(d, panel.title, box.x + box.w / 2, box.y - 14, { size: 12, align: 'center', color: '#1a202c' });
  if (framed) {
    const at = (axis, k) => (axis.log ? 10 ** k : k);
    d.strokeStyle = '#e2e8f0'; d.lineWidth = 1; d.setLineDash([]);
    X.ticks.forEach(k => { d.beginPath(); d.moveTo(px(at(X, k)), box.y); d.lineTo(px(at(X, k)), box.y + box.h); d.stroke(); letter(d, X.say(k), px(at(X, k)), box.y + box.h + 15, { size: 10, align: 'center' }); });
    Y.ticks.forEach(k => { d.strokeStyle = '#e2e8f0'; d.beginPath(); d.moveTo(box.x, py(at(Y, k))); d.lineTo(box.x + box.w, py(at(Y, k))); d.stroke(); letter(d, Y.say(k), box.x - 8, py(at(Y, k)), { size: 10, align: 'right' }); });
    d.strokeStyle = '#718096'; d.beginPath(); d.moveTo(box.x, box.y); d.lineTo(box.x, box.y + box.h); d.lineTo(box.x + box.w, box.y + box.h); d.stroke();
    if (panel.xlabel) letter(d, panel.xlabel, box.x + box.w / 2, box.y + box.h + 36, { align: 'center' });
    if (panel.ylabel) { d.save(); d.translate(box.x - 58, box.y + box.h / 2); d.rotate(-Math.PI / 2); letter(d, panel.ylabel, 0, 0, { align: 'center' }); d.restore(); }
  }
  d.save(); d.beginPath(); d.rect(box.x - 3, box.y - 3, box.w + 6, box.h + 6); d.clip();
  items.forEach(item => {
    const [a, b, u, v] = item.items;
    d.strokeStyle = d.fillStyle = item.ink; d.lineWidth = item.width || 2; d.lineJoin = 'round'; d.setLineDash(item.dash ? [7, 5] : []);
    if (item.kind === 'line') {
      let down = false;
      d.beginPath();
      a.forEach((x, k) => { const p = px(x), q = py(b[k]); if (!(isFinite(p) && isFinite(q))) down = false; else if (down) d.lineTo(p, q); else { d.moveTo(p, q); down = true; } });
      if (item.fill) { d.globalAlpha = item.opacity || 1; d.fill(); d.globalAlpha = 1; } else d.stroke();
    } else if (item.kind === 'points') a.forEach((x, k) => drawShape(d, item.shape, px(x), py(b[k]), 4 * (item.size || 1)));
    else if (item.kind === 'arrows') a.forEach((x, k) => { if (real(x) && real(u[k])) drawArrow(d, px(x), py(b[k]), px(x + u[k]), py(b[k] + v[k]), item.head); });
    else if (item.kind === 'mark') {
      d.lineWidth = 1.2; d.setLineDash(item.dash === false ? [] : [5, 4]); d.beginPath();
      if (real(item.x)) { d.moveTo(px(item.x), box.y); d.lineTo(px(item.x), box.y + box.h); } else { d.moveTo(box.x, py(item.y)); d.lineTo(box.x + box.w, py(item.y)); }
      d.stroke();
      if (item.label) letter(d, item.label, real(item.x) ? px(item.x) + 5 : box.x + 8, real(item.x) ? box.y + 10 : py(item.y) - 9, { size: 10, color: item.ink });
    }
    d.setLineDash([]);
  });
  d.restore();
  items.filter(i => i.kind === 'text').forEach(i => letter(d, i.items[0], px(i.at[0]), py(i.at[1]), { size: i.size || 11, align: i.align || 'left', color: i.ink, halo: true }));
  legend(d, panel, items, box.x, box.y, box.w, box.h);
}
