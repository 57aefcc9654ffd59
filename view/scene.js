// SPDX-License-Identifier: MIT
// The scene: what is drawn where, at a time t, from a camera { yaw, pitch, distance, target }.
const okabeIto = ['#d55e00', '#0072b2', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#f0e442'];
const mixed = (c, d, s) => c.map((x, i) => x + s * (d[i] - x));
function makeScene(run, canvas) {
  const g = run.head.gravity, up = norm(g) > 0 ? unit(scale(g, -1)) : [0, 0, 1], turned = turnTo(up);
  const moving = run.bodies.map((b, i) => i).filter(i => !run.bodies[i].static);
  const color = i => okabeIto[Math.max(0, moving.indexOf(i)) % okabeIto.length];
  const reach = b => (b.kind === 'plane' ? 0 : Math.max(...b.axes) * (b.exponents.every(e => e !== null && e <= 2) ? 1 : 1.5) + norm(b.offset));
  // The box of the motion, and where bodies are at many times for the trails.
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity], paths = new Map();
  run.bodies.forEach((b, i) => {
    if (b.kind === 'plane') return;
    const path = [], most = Math.max(2, Math.ceil(6000 / run.bodies.length)), times = norm(b.trail) > 0 ? run.times(i) : b.list.map(k => k.t);
    for (let k = 0; k <= 400 && !b.static; k++) times.push(Math.min(run.begin + (run.end - run.begin) * k / 400, run.end));
    const some = times.sort((x, y) => x - y), step = Math.max(1, Math.ceil(some.length / most));
    some.forEach((t, k) => {
      const { x, q } = run.state(i, clamp(t, run.begin, run.end)), r = reach(b);
      for (let c = 0; c < 3; c++) { low[c] = Math.min(low[c], x[c] - r); high[c] = Math.max(high[c], x[c] + r); }
      if (k % step === 0 || k === some.length - 1) path.push([...add(x, qrot(q, b.trail)), t]);
    });
    if (!b.static) paths.set(i, path);
  });
  if (!(low[0] < high[0])) [low.fill(-1), high.fill(1)];
  const center = scale(add(low, high), 0.5), radius = Math.max(norm(sub(high, low)) / 2, 1e-12), here = x => sub(x, center);
  // A plane's half extents: its own, or the box of the motion and a fifth more.
  const planes = run.bodies.filter(b => b.kind === 'plane').map(b => {
    const k = b.list[0], n = qrot(k.q, [0, 0, 1]), e = [[1, 0, 0], [0, 1, 0]].map(v => qrot(k.q, v));
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map(s => sub([0, 1, 2].map(c => (s >> c & 1 ? high : low)[c]), k.x));
    const side = e.map((axis, c) => {
      const p = corners.map(v => dot(v, axis)), a = Math.min(...p), z = Math.max(...p), room = 0.1 * (z - a) + 0.1 * radius;
      return b.axes[c] === null ? [(a + z) / 2, (z - a) / 2 + room] : [0, Math.min(b.axes[c], Math.max(-a, z) + 4 * radius)];
    });
    const x = add(k.x, add(scale(e[0], side[0][0]), scale(e[1], side[1][0])));
    const model = frame(here(x), k.q, [side[0][1], side[1][1], 1]);
    const ring = [[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]].map(([p, q]) =>
      [...here(add(x, add(scale(e[0], p * side[0][1]), scale(e[1], q * side[1][1])))), -1e30]);
    return { model, ring, n, x: here(x), floor: dot(n, up) > 0.9, half: side.map(s => s[1]) };
  });
  const step = (() => { const s = radius / 3, p = 10 ** Math.floor(Math.log10(s)); return p * [1, 2, 5, 10].reduce((a, b) => Math.abs(b - s / p) < Math.abs(a - s / p) ? b : a); })();
  const strongest = Math.max(1e-300, ...run.events.map(e => norm(e.impulse)));
  // Walls are seen from before: their normals' mean, and a bit to the side.
  const east = qrot(turned, [1, 0, 0]), north = qrot(turned, [0, 1, 0]);
  const free = planes.filter(p => !p.floor).reduce((sum, p) => add(sum, p.n), [0, 0, 0]);
  const front = Math.hypot(dot(free, east), dot(free, north)) > 1e-9 ? Math.atan2(dot(free, north), dot(free, east)) + 0.95 : -1.1;
  // As near as all of the motion's box is seen, and the walls.
  const seenAll = [0, 1, 2, 3, 4, 5, 6, 7].map(s => here([0, 1, 2].map(c => (s >> c & 1 ? high : low)[c]))).concat(planes.filter(p => !p.floor).flatMap(p => p.ring.map(q => q.slice(0, 3))));
  const back = (yaw, pitch) => add(scale(add(scale(east, Math.cos(yaw)), scale(north, Math.sin(yaw))), Math.cos(pitch)), scale(up, Math.sin(pitch)));
  const home = { yaw: front, pitch: 0.32, distance: distanceFor(seenAll, canvas.clientWidth / canvas.clientHeight || 1.2, back(front, 0.32), up), target: [0, 0, 0] };
  const camera = { ...home };
  const G = makeGraphics(canvas);
  if (!G) return { camera, home, center, radius, up, moving, color, step, draw: () => null };
  const shapes = new Map(), most = clamp(Math.floor(Math.sqrt(30000 / (48 * Math.max(1, run.bodies.length - planes.length)))), 3, 40);
  // Equal shapes share a mesh, and of ellipsoids one for each size on the screen.
  const solids = run.bodies.map((b, i) => {
    if (b.kind === 'plane') return null;
    const id = JSON.stringify([b.kind, b.axes, b.exponents, b.rounding, b.vertices]), size = Math.max(...b.axes);
    const meshAt = pixels => {
      const lines = isEllipsoid(b) ? Math.min(gridLines(pixels), most) : most, key = id + lines;
      if (!shapes.has(key)) shapes.set(key, G.upload(mesh(b, lines)));
      return shapes.get(key);
    };
    return { meshAt, size, one: b.static ? rgb('#8a8f98') : rgb(color(i)), i };
  });
  const arrow = G.upload(arrowMesh()), dot3 = G.upload(mesh({ kind: 'sphere', axes: [1, 1, 1], exponents: [2, 2, 2] }, 2)), quad = G.upload(quadMesh);
  const third = G.upload({ points: [0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1], index: [0, 1, 2] }), edge = G.uploadLine([[0, 0, 0, -1e30], [1, 0, 0, -1e30]]);
  // A patch's points in order round their middle, drawn as a face with its outline, a little before the bodies' faces.
  const outline = (points, n) => {
    const middle = scale(points.reduce(add), 1 / points.length), e = qrot(turnTo(n), [1, 0, 0]), f = cross(n, e);
    return points.map(x => [Math.atan2(dot(sub(x, middle), f), dot(sub(x, middle), e)), here(x)]).sort((x, y) => x[0] - y[0]).map(x => x[1]);
  };
  planes.forEach(p => { p.line = G.uploadLine(p.ring); });
  paths.forEach((path, i) => paths.set(i, G.uploadLine(bent(apart(path, 1e-3 * radius), 3e-4 * radius).map(([x, y, z, t]) => [...here([x, y, z]), t]))));
  const circle = G.uploadLine(Array.from({ length: 33 }, (_, k) => [Math.cos(k * Math.PI / 16), Math.sin(k * Math.PI / 16), 0, -1e30]));
  const sun = unit(qrot(turned, [-0.45, -0.5, 1])), lit = 1.35 * radius;
  const shadowPixels = G.size / 2 / lit / 4; // to a pixel of the map, of which the shade takes nine
  const lightView = mat(parallel(lit, 0.1 * radius, 8 * radius), look(scale(sun, 4 * radius), [0, 0, 0], north));
  const eyeOf = () => add(camera.target, scale(back(camera.yaw, camera.pitch), camera.distance));
  const at = t => clamp(t, run.begin, run.end);
  let last = null;
  const modelsAt = (t, before) => solids.map(s => {
    if (!s) return null;
    const b = run.bodies[s.i], k = run.state(s.i, at(t), before);
    return frame(here(add(k.x, qrot(k.q, b.offset))), qmul(k.q, b.turn), [1, 1, 1]);
  });
  // Draws at time t; tail: seconds that impulses stay; poses: other times at which the bodies are seen as well, paler.
  function draw(t, before, tail, dark, follow, poses = []) {
    const { gl } = G, w = canvas.width, h = canvas.height, paper = dark ? '#14161a' : '#f7f6f3', ink = dark ? '#e8e6e1' : '#23262b';
    if (follow >= 0) camera.target = here(run.state(follow, at(t), before).x);
    const eye = eyeOf(), far = camera.distance + 6 * radius;
    const view = mat(perspective(lens(w / h), w / h, Math.max(camera.distance - 3 * radius, camera.distance * 0.02), far), look(eye, camera.target, up));
    const models = modelsAt(t, before), others = poses.map(p => modelsAt(p, false));
    gl.enable(gl.DEPTH_TEST); gl.depthFunc(gl.LESS); gl.disable(gl.BLEND); gl.depthMask(true);
    gl.bindFramebuffer(gl.FRAMEBUFFER, G.frameBuffer); gl.viewport(0, 0, G.size, G.size); gl.clear(gl.DEPTH_BUFFER_BIT);
    G.dark.set({ view: lightView });
    [models, ...others].forEach(m => solids.forEach((s, i) => { if (s) { G.dark.set({ model: m[i] }); G.draw(s.meshAt(s.size * shadowPixels)); } }));
    gl.bindFramebuffer(gl.FRAMEBUFFER, null); gl.viewport(0, 0, w, h); gl.clearColor(...rgb(paper)); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    G.solid.set({ view, light: lightView, eye, sun, sky: up, depth: 0, texel: 1 / G.size, kind: 1, grid: [0, 0, 0, 0] });
    const meshIn = (s, model) => s.meshAt(lens(w / h) * h / 2 * s.size / Math.max(norm(sub(eye, model.slice(12, 15))), 1e-3 * camera.distance));
    const solid = (m, model, one, two, kind, grid = [0, 0, 1, 1]) => { G.solid.set({ model, one, two, kind, grid }); G.draw(m); };
    const stroke = (m, one, width, now = 1e30) => { G.lines.set({ view, size: [w / 2, h / 2], one, width: width * (canvas.clientWidth ? w / canvas.clientWidth : window.devicePixelRatio || 1), now }); G.drawLine(m); };
    solids.forEach((s, i) => s && solid(meshIn(s, models[i]), models[i], s.one, mixed(s.one, [1, 1, 1, 1], 0.58), 1));
    others.forEach(m => solids.forEach((s, i) => {
      if (s && !run.bodies[s.i].static) solid(meshIn(s, m[i]), m[i], mixed(s.one, rgb(paper), 0.55), mixed(s.one, rgb(paper), 0.85), 1);
    }));
    const ground = p => solid(quad, p.model, rgb(dark ? '#2b2f36' : p.floor ? '#e4e1da' : '#c3ccd6', p.floor ? 1 : 0.35), rgb(ink, 0.2), 2, [0, 0, p.half[0] / step, p.half[1] / step]);
    const seen = p => dot(p.n, sub(eye, p.x)) > 0;
    planes.filter(p => p.floor && seen(p)).forEach(ground);
    gl.enable(gl.BLEND); gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    planes.forEach(p => stroke(p.line, rgb(ink, 0.45), 1.2));
    paths.forEach((line, i) => stroke(line, rgb(color(i), moving.length > 6 ? 0.45 : 0.9), moving.length > 6 ? 1.4 : 2.5, t));
    planes.filter(p => !p.floor && seen(p)).forEach(ground); gl.depthMask(true);
    const spot = camera.distance * 0.005;
    const mark = (m, model, one) => [[gl.LEQUAL, 1], [gl.GREATER, 0.35]].forEach(([f, a]) => {
      gl.depthFunc(f); gl.depthMask(f === gl.LEQUAL); solid(m, model, [...one.slice(0, 3), one[3] * a], one, 0); gl.depthMask(true); gl.depthFunc(gl.LESS);
    });
    const past = run.events.filter(e => e.kind === 'impact' && (e.t < t || (e.t === t && !before)));
    past.slice(-100).forEach(e => mark(dot3, frame(here(e.point), [1, 0, 0, 0], [spot, spot, spot]), rgb(ink, 0.5)));
    past.filter(e => t - e.t <= tail && norm(e.impulse) > 0).slice(-40).forEach(e => {
      const size = 0.42 * camera.distance * Math.sqrt(norm(e.impulse) / strongest) * 0.6, wide = Math.min(0.12 * size, 3.2 * spot);
      mark(arrow, frame(here(e.point), turnTo(unit(e.impulse)), [wide, wide, size]), rgb('#e69f00', 1 - 0.75 * (t - e.t) / tail));
    });
    run.held(t).forEach(c => {
      const round = c.points.length > 1 ? outline(c.points, c.n) : [], span = (x, y, z) => [...sub(y, x), 0, ...sub(z, x), 0, ...c.n, 0, ...x, 1];
      for (let k = 2; k < round.length; k++) mark(third, span(round[0], round[k - 1], round[k]), rgb('#009e73', 0.55));
      round.forEach((x, k) => { G.lines.set({ view: mat(view, span(x, round[(k + 1) % round.length], x)), size: [w / 2, h / 2], one: rgb('#009e73', 0.9), width: 2, now: 1e30 }); G.drawLine(edge); });
      const f = norm(c.force), weight = (run.bodies[c.body1].mass || 1) * Math.max(norm(g), 1e-9), size = 0.16 * camera.distance * Math.min(2, Math.sqrt(f / weight));
      mark(dot3, frame(here(c.point), [1, 0, 0, 0], [spot, spot, spot]), rgb(ink));
      if (c.mode === 'slip') { G.lines.set({ view: mat(view, frame(here(c.point), turnTo(c.n), [3 * spot, 3 * spot, 1])), size: [w / 2, h / 2], one: rgb(ink), width: 2, now: 1e30 }); G.drawLine(circle); }
      if (f > 0) mark(arrow, frame(here(c.point), turnTo(unit(c.force)), [1.6 * spot, 1.6 * spot, size]), rgb('#009e73', 0.9));
    });
    last = { view, w, h };
  }
  // Where a body's centre is on the canvas, in its pixels from the lower left.
  const project = i => {
    const m = last.view, x = here(run.state(i, at(run.shown)).x), c = [0, 1, 3].map(r => m[r] * x[0] + m[r + 4] * x[1] + m[r + 8] * x[2] + m[r + 12]);
    return [(c[0] / c[2] * 0.5 + 0.5) * last.w, (c[1] / c[2] * 0.5 + 0.5) * last.h];
  };
  return { camera, home, center, radius, up, east, north, moving, color, step, draw, project, gl: G.gl };
}
