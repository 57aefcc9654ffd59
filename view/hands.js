// SPDX-License-Identifier: MIT
// The page: time, camera, keys, and what a test asks of it.
function start(bytes) {
  const page = id => document.getElementById(id), root = document.documentElement, run = openRecord(bytes), canvas = page('scene');
  const scene = makeScene(run, canvas), panels = makePanels(run, scene, page), camera = scene.camera, list = run.events;
  const dark = () => window.matchMedia('(prefers-color-scheme: dark)').matches;
  const option = (select, text, value) => { const o = document.createElement('option'); o.textContent = text; o.value = value; page(select).appendChild(o); };
  const status = { t: run.begin, before: false, play: 0, follow: -1, dirty: true, poses: [], drawn: 0, share: 1 }; // play, drawn: the wall clock of the last frame; drawn: 0 once things stand
  scene.moving.forEach(i => option('body', run.bodies[i].name, i));
  panels.quantities.forEach(name => option('what', name, name));
  page('what').value = 'z, m';
  // At first the speed at which the run lasts some six seconds; and digits of time to a ten thousandth of it.
  const rates = [...page('rate').options].map(o => Number(o.value)), span = run.end - run.begin || 1, wanted = Math.log(span / 6);
  page('rate').value = String(rates.reduce((a, b) => (Math.abs(Math.log(b) - wanted) < Math.abs(Math.log(a) - wanted) ? b : a)));
  const places = clamp(4 - Math.floor(Math.log10(span)), 0, 20), time = t => (span < 1e-3 || span > 1e6 ? t.toExponential(5) : t.toFixed(places));
  page('name').textContent = run.head.name;
  page('facts').textContent = `${run.bodies.length} bodies, ${list.length} events, ${say(run.end)} s, ${run.head.reason}; grid ${say(scene.step)} m; ${run.head.thinned ? 'thinned for this page to ' + run.head.thinned + ' of a body' : 'exact to ' + run.head.tolerance}`;
  if (!scene.gl) page('none').hidden = false;
  const small = x => (x < 1e-3 ? x.toExponential(2) : x.toPrecision(3));
  const rows = list.slice(0, 500).map(e => {
    const row = document.createElement('button');
    [time(e.t), e.kind + ' ' + e.name1 + (e.name2 ? ' – ' + e.name2 : ''), norm(e.impulse) > 0 ? small(norm(e.impulse)) + ' N s' : ''].forEach(text => {
      const cell = document.createElement('span');
      cell.textContent = text;
      row.appendChild(cell);
    });
    row.title = [e.kind, e.name1, e.name2, e.phases].join(' ');
    row.addEventListener('click', () => { status.play = 0; go(e.t); });
    page('events').appendChild(row);
    return row;
  });
  const body = () => Number(page('body').value);
  function go(t, before = false) { status.t = clamp(t, run.begin, run.end); status.before = before; status.dirty = true; }
  function cite() {
    const c = [camera.yaw, camera.pitch, camera.distance / scene.radius].map(x => +x.toFixed(3));
    history.replaceState(null, '', `#t=${+status.t.toFixed(9)}${status.before ? '&before' : ''}&yaw=${c[0]}&pitch=${c[1]}&near=${c[2]}`);
  }
  function read() {
    const words = new URLSearchParams(location.hash.slice(1)), number = (k, d) => words.has(k) && isFinite(words.get(k)) ? Number(words.get(k)) : d;
    camera.yaw = number('yaw', camera.yaw); camera.pitch = clamp(number('pitch', camera.pitch), -1.5, 1.5);
    camera.distance = clamp(number('near', camera.distance / scene.radius), 0.01, 100) * scene.radius;
    go(number('t', status.t), words.has('before'));
    if (words.has('still')) { root.classList.add('still'); status.poses = (words.get('poses') || '').split(',').filter(p => p !== '').map(Number); }
    return words;
  }
  function show(share = 1) {
    const r = Math.min(window.devicePixelRatio || 1, 2) * share, w = Math.round(canvas.clientWidth * r), h = Math.round(canvas.clientHeight * r);
    if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
    run.shown = status.t;
    const tail = 0.25 * Number(page('rate').value);
    scene.draw(status.t, status.before, Math.max(tail, 1e-9), dark(), status.follow, status.poses);
    if (root.classList.contains('still')) return;
    panels.energy(status.t); panels.ticks(status.t);
    if (scene.moving.length) { panels.sphere(status.t, status.before, body()); panels.graph(status.t, body(), page('what').value); }
    page('time').value = (status.t - run.begin) / (run.end - run.begin || 1);
    page('clock').textContent = `t = ${time(status.t)} s${status.before ? ' (before)' : ''}`;
    rows.forEach((row, k) => row.classList.toggle('now', list[k].t === status.t));
    const now = rows.find((_, k) => list[k].t === status.t), box = page('events');
    if (now) box.scrollTop = clamp(box.scrollTop, now.offsetTop + now.offsetHeight - box.clientHeight, now.offsetTop);
  }
  function tick(clock) {
    if (status.play) {
      go(status.t + Math.min(clock - status.play, 100) / 1000 * Number(page('rate').value));
      status.play = status.t < run.end ? clock : 0;
      page('play').textContent = status.play ? 'Pause' : 'Play';
    }
    // Where frames take more than 60 ms, as of a GPU in software, they have fewer pixels while things move, and all once they stand.
    if (status.dirty) {
      if (status.drawn && clock - status.drawn > 60) status.share = Math.max(0.4, 0.8 * status.share);
      status.dirty = false; status.drawn = clock;
      show(status.share);
    } else if (status.drawn) {
      status.drawn = 0;
      if (status.share < 1) show();
    }
    requestAnimationFrame(tick);
  }
  function toggle() {
    if (!status.play && status.t >= run.end) go(run.begin);
    status.play = status.play ? 0 : performance.now();
    page('play').textContent = status.play ? 'Pause' : 'Play';
    if (!status.play) cite();
  }
  // From event to event, and there from before to after.
  function hop(way) {
    const next = way > 0 ? list.find(e => e.t > status.t) : list.filter(e => e.t < status.t).pop(), here = list.some(e => e.t === status.t);
    status.play = 0;
    if (here && status.before === way > 0) return go(status.t, way < 0);
    return next ? go(next.t, way > 0) : go(way > 0 ? run.end : run.begin);
  }
  const keys = { ' ': toggle, ArrowRight: () => hop(1), ArrowLeft: () => hop(-1), ',': () => go(status.t - 1 / 240), '.': () => go(status.t + 1 / 240),
    Home: () => go(run.begin), End: () => go(run.end), h: () => { Object.assign(camera, scene.home, { target: [0, 0, 0] }); status.follow = -1; },
    f: () => { status.follow = status.follow < 0 && scene.moving.length ? body() : -1; }, p: save };
  function save() {
    const [w, h] = [canvas.width, canvas.height], link = document.createElement('a');
    canvas.width = 2 * w; canvas.height = 2 * h;
    scene.draw(status.t, status.before, 1, dark(), status.follow);
    link.href = canvas.toDataURL('image/png'); link.download = 'scene.png'; link.click();
  }
  addEventListener('keydown', e => {
    if (e.ctrlKey || e.metaKey || e.altKey || !keys[e.key] || (e.target.tagName === 'SELECT') || (e.key === ' ' && e.target.tagName === 'BUTTON')) return;
    e.preventDefault(); keys[e.key](); status.dirty = true; if (!status.play) cite();
  });
  page('play').addEventListener('click', toggle);
  page('back').addEventListener('click', () => { hop(-1); cite(); });
  page('on').addEventListener('click', () => { hop(1); cite(); });
  page('time').addEventListener('input', e => { status.play = 0; go(run.begin + e.target.value * (run.end - run.begin)); });
  page('time').addEventListener('change', cite);
  ['body', 'what', 'rate'].forEach(id => page(id).addEventListener('change', () => { status.dirty = true; }));
  cameraHands(scene, canvas, page('sphere'), panels.view, () => { status.dirty = true; }, cite);
  canvas.addEventListener('webglcontextlost', e => { e.preventDefault(); });
  canvas.addEventListener('webglcontextrestored', () => location.reload());
  ['resize', 'hashchange'].forEach(k => addEventListener(k, () => { if (k === 'hashchange') read(); status.dirty = true; }));
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { status.dirty = true; });
  // ---- for tests: #check, #probe=t1,t2, #press=key,key ----
  const words = read();
  if (words.has('press')) words.get('press').split(',').forEach(k => dispatchEvent(Object.assign(new KeyboardEvent('keydown', { key: k === 'space' ? ' ' : k, cancelable: true }))));
  show();
  if (words.has('check') || words.has('probe')) {
    const states = t => run.bodies.map((_, i) => { const s = run.state(i, t); return [...s.x, ...s.q, ...s.v, ...s.w]; });
    const pixel = i => { const p = new Uint8Array(4), [x, y] = scene.project(i); scene.gl.readPixels(x, y, 1, 1, scene.gl.RGBA, scene.gl.UNSIGNED_BYTE, p); return [...p.slice(0, 3)]; };
    const report = { t: status.t, before: status.before, playing: status.play > 0, events: list.length, requests: performance.getEntriesByType('resource').length, error: scene.gl ? scene.gl.getError() : -1, pixels: scene.gl ? scene.moving.map(pixel) : [],
      states: (words.get('probe') || String(status.t)).split(',').map(t => states(Number(t))) };
    root.dataset.report = JSON.stringify(report);
  }
  if (words.has('still') && words.has('strip') && scene.gl) return drawStrip(scene, canvas, words.get('strip').split(',').map(Number), dark);
  requestAnimationFrame(tick);
}
