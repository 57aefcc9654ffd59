// SPDX-License-Identifier: MIT
// The camera: its lens, how far off it stands, and hands on it: drag, wheel, two fingers; and on the ball of orientations.
const lens = aspect => 2.2 * Math.min(1, aspect / 1.3);
// How far back along z from the origin all of the points are seen.
function distanceFor(points, aspect, z, up) {
  const x = unit(cross(up, z)), y = cross(z, x);
  return 1.04 * Math.max(...points.map(p => dot(p, z) + lens(aspect) * Math.max(Math.abs(dot(p, x)) / aspect, Math.abs(dot(p, y)))));
}
// A way without points that are no pixel apart, which have no direction.
function apart(path, least) {
  const kept = [path[0]];
  path.forEach((p, k) => { if (k === path.length - 1 || norm(sub(p.slice(0, 3), kept[kept.length - 1])) > least) kept.push(p); });
  return kept;
}
// A way without points that lie so near to the line between those that stay.
function bent(path, least) {
  const stays = new Set([0, path.length - 1]), open = [[0, path.length - 1]];
  const off = (p, a, b) => {
    const d = sub(b, a), s = clamp(dot(sub(p, a), d) / (dot(d, d) || 1), 0, 1);
    return norm(sub(sub(p, a), scale(d, s)));
  };
  while (open.length) {
    const [from, to] = open.pop(), [a, b] = [path[from], path[to]].map(p => p.slice(0, 3));
    let worst = least, at = 0;
    for (let k = from + 1; k < to; k++) { const e = off(path[k].slice(0, 3), a, b); if (e > worst) [worst, at] = [e, k]; }
    if (at) { stays.add(at); open.push([from, at], [at, to]); }
  }
  return path.filter((_, k) => stays.has(k));
}
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
