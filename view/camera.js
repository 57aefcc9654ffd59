// SPDX-License-Identifier: MIT
// Hands on the camera: drag, wheel, two fingers; and on the ball of orientations.
function cameraHands(scene, canvas, ball, ballView, changed, done) {
  const camera = scene.camera, fingers = new Map(), spread = () => { const [a, b] = [...fingers.values()]; return Math.hypot(a[0] - b[0], a[1] - b[1]); };
  const turn = (view, dx, dy) => { view.yaw -= dx * 0.008; view.pitch = clamp(view.pitch + dy * 0.008, -1.5, 1.5); };
  const near = factor => { camera.distance = clamp(camera.distance * factor, 0.02 * scene.radius, 50 * scene.radius); };
  const pan = (dx, dy) => {
    const s = camera.distance / canvas.clientHeight, right = add(scale(scene.east, -Math.sin(camera.yaw)), scale(scene.north, Math.cos(camera.yaw)));
    camera.target = add(camera.target, add(scale(right, -dx * s), scale(scene.up, dy * s)));
  };
  const move = (e, view) => {
    const [x, y] = fingers.get(e.pointerId), wide = fingers.size === 2 ? spread() : 0, dx = e.clientX - x, dy = e.clientY - y;
    fingers.set(e.pointerId, [e.clientX, e.clientY]);
    if (view !== camera) turn(view, -dx, dy);
    else if (fingers.size === 2) { near(wide / Math.max(spread(), 1)); pan(dx / 2, dy / 2); } else if (e.shiftKey) pan(dx, dy);
    else turn(camera, dx, dy);
    changed();
  };
  const drag = (element, view) => {
    element.addEventListener('pointerdown', e => { fingers.set(e.pointerId, [e.clientX, e.clientY]); element.setPointerCapture(e.pointerId); });
    ['pointerup', 'pointercancel'].forEach(k => element.addEventListener(k, e => { fingers.delete(e.pointerId); done(); }));
    element.addEventListener('pointermove', e => { if (fingers.has(e.pointerId)) move(e, view); });
  };
  drag(canvas, camera);
  drag(ball, ballView);
  canvas.addEventListener('wheel', e => { e.preventDefault(); near(Math.exp(e.deltaY * 0.001)); changed(); }, { passive: false });
}
