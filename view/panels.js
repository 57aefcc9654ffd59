// SPDX-License-Identifier: MIT
// Flat panels: the curve on S3, the energy, any quantity over time, and the scrubber with its ticks.
function makePanels(run, scene, page) {
  const theme = () => { const s = getComputedStyle(document.documentElement); return k => s.getPropertyValue('--' + k).trim(); }; // and a colour, by its digits, where dark has another
  const hue = (ink, c) => ink(c.slice(1)) || c;
  const span = run.end - run.begin || 1;
  const fit = id => {
    const c = page(id), r = window.devicePixelRatio || 1, w = c.clientWidth, h = c.clientHeight;
    if (c.width !== Math.round(w * r)) c.width = Math.round(w * r);
    if (c.height !== Math.round(h * r)) c.height = Math.round(h * r);
    const d = c.getContext('2d', { willReadFrequently: true });
    // drawn by the processor: small pictures of thin lines are slow by a GPU, and slower by one in software
    d.setTransform(r, 0, 0, r, 0, 0); d.clearRect(0, 0, w, h); d.font = '11px system-ui, sans-serif'; d.lineJoin = 'round';
    return { d, w, h, ink: theme() };
  };
  const times = Array.from({ length: 401 }, (_, k) => Math.min(run.begin + span * k / 400, run.end));
  const both = [...new Set([...times, ...run.events.map(e => e.t)])].sort((a, b) => a - b).flatMap(t => run.events.length < 2000 && run.events.some(e => e.t === t) ? [[t, true], [t, false]] : [[t, false]]);
  // ---- what can be drawn over time ----
  const inertia = (b, s) => { const w = qrot(conj(s.q), s.w); return dot(w.map((x, i) => x * x), b.moments) / 2; };
  const quantities = {
    'x, m': s => s.x[0], 'y, m': s => s.x[1], 'z, m': s => s.x[2], 'speed, m/s': s => norm(s.v), 'ωx, rad/s': s => s.w[0], 'ωy, rad/s': s => s.w[1], 'ωz, rad/s': s => s.w[2],
    'q0': s => s.q[0], 'q1': s => s.q[1], 'q2': s => s.q[2], 'q3': s => s.q[3], 'spin, J': (s, b) => inertia(b, s), 'motion, J': (s, b) => b.mass * dot(s.v, s.v) / 2 };
  const cache = new Map(), column = (i, name) => {
    if (!cache.has(i + name)) cache.set(i + name, both.map(([t, before]) => quantities[name](run.state(i, t, before), run.bodies[i])));
    return cache.get(i + name);
  };
  // Three digits, and none of zeros: 0.00513 is 5.13e-3.
  const short = x => { const t = String(+x.toPrecision(3)); return t.length > 6 || Math.abs(x) < 0.01 && x !== 0 ? x.toExponential(2).replace('e+', 'e') : t; };
  function plot({ d, w, h, ink }, lines, t, unit) {
    const values = lines.flatMap(l => l.y), low = values.reduce((x, y) => Math.min(x, y), 0), most = values.reduce((x, y) => Math.max(x, y), low), high = most > low ? most : low + 1;
    const marks = [low, (low + high) / 2, high].map(y => [y, short(y)]), l = 8 + Math.max(...marks.map(m => d.measureText(m[1]).width)), b = h - 16;
    const X = x => l + (w - l - 8) * (x - run.begin) / span, Y = y => b - (b - 14) * (y - low) / (high - low);
    d.strokeStyle = ink('faint'); d.fillStyle = ink('soft'); d.lineWidth = 1; d.textAlign = 'right';
    marks.forEach(([y, text]) => { d.beginPath(); d.moveTo(l, Y(y)); d.lineTo(w - 8, Y(y)); d.stroke(); d.fillText(text, l - 4, Y(y) + 4); });
    d.textAlign = 'left'; d.fillText(unit, l, 10); d.textAlign = 'right'; d.fillText(say(run.end) + ' s', w - 8, h - 3);
    lines.forEach(s => {
      d.strokeStyle = hue(ink, s.color); d.lineWidth = 1.8; d.setLineDash(s.dash || []); d.beginPath();
      s.x.forEach((x, k) => (k ? d.lineTo(X(x), Y(s.y[k])) : d.moveTo(X(x), Y(s.y[k])))); d.stroke();
    });
    d.setLineDash([]); d.strokeStyle = ink('ink'); d.lineWidth = 1; d.beginPath(); d.moveTo(X(t), 12); d.lineTo(X(t), b); d.stroke();
  }
  let energies = null; // potential, kinetic, of it spin, lost, total
  function addEnergies() {
    const sums = name => scene.moving.map(i => column(i, name)).reduce(add, both.map(() => 0)), spin = sums('spin, J'), least = run.account.reduce((x, a) => Math.min(x, a.potential), Infinity);
    const spun = both.map(([s]) => s), at = run.account.map(a => a.t), of = (color, f, dash) => ({ color, x: at, y: run.account.map(f), dash });
    return [of(okabeIto[2], a => a.potential - least, [5, 3]), { color: okabeIto[1], x: spun, y: add(sums('motion, J'), spin) }, { color: okabeIto[3], x: spun, y: spin, dash: [2, 2] },
      of(okabeIto[0], a => a.losses.reduce((x, y) => x + y, 0), [8, 3, 2, 3]), of(null, a => a.E - least)];
  }
  function energy(t) {
    const p = fit('energy');
    if (run.account.length) plot(p, (energies = energies || addEnergies()).map(l => ({ ...l, color: l.color || p.ink('ink') })), t, 'J');
  }
  // ---- the curve on S3, by (q1, q2, q3) in the unit ball; dashed where q0 < 0 ----
  const view = { yaw: -0.7, pitch: 0.35 }, ways = new Map();
  const turnsOf = body => {
    if (!ways.has(body)) {
      const times = run.times(body), step = Math.max(1, Math.ceil(times.length / 4000));
      ways.set(body, times.filter((_, k) => k % step === 0).map(t => [t, run.state(body, t).q]));
    }
    return ways.get(body);
  };
  function sphere(t, before, body) {
    const { d, w, h, ink } = fit('sphere'), R = Math.min(w, h) / 2 - 12;
    const cy = Math.cos(view.yaw), sy = Math.sin(view.yaw), cp = Math.cos(view.pitch), sp = Math.sin(view.pitch);
    const P = q => { const a = cy * q[0] + sy * q[1], b = -sy * q[0] + cy * q[1]; return [w / 2 + R * a, h / 2 - R * (cp * q[2] + sp * b)]; };
    const path = (points, color, width, dash = []) => { d.strokeStyle = hue(ink, color); d.lineWidth = width; d.setLineDash(dash); d.beginPath(); points.forEach((q, k) => (k ? d.lineTo(...P(q)) : d.moveTo(...P(q)))); d.stroke(); };
    d.fillStyle = ink('panel'); d.beginPath(); d.arc(w / 2, h / 2, R, 0, 7); d.fill(); d.strokeStyle = ink('soft'); d.lineWidth = 1; d.stroke();
    const ring = f => Array.from({ length: 49 }, (_, k) => f(Math.cos(k * Math.PI / 24), Math.sin(k * Math.PI / 24)));
    [ring((c, s) => [c, s, 0]), ring((c, s) => [c, 0, s]), ring((c, s) => [0, c, s])].forEach(r => path(r, ink('faint'), 1));
    [[okabeIto[0], [1, 0, 0], 'q1'], [okabeIto[2], [0, 1, 0], 'q2'], [okabeIto[1], [0, 0, 1], 'q3']].forEach(([c, e, name]) => {
      path([[0, 0, 0], e], c, 1.5); d.setLineDash([]); d.fillStyle = hue(ink, c); d.textAlign = 'left'; d.fillText(name, P(e)[0] + 4, P(e)[1] - 3);
    });
    const turns = turnsOf(body), color = scene.color(body);
    let part = [], negative = null;
    const end = late => { if (part.length > 1) { d.globalAlpha = late ? 0.3 : 1; path(part, color, 2.2, negative ? [4, 3] : []); d.globalAlpha = 1; } };
    let late = false;
    for (const [time, q] of turns) {
      const point = q.slice(1), now = time > t;
      if ((negative !== null && q[0] < 0 !== negative) || now !== late) { part.push(point); end(late); part = []; }
      part.push(point); negative = q[0] < 0; late = now;
    }
    end(late);
    const q = run.state(body, t, before).q, dotAt = P(q.slice(1));
    d.setLineDash([]); d.fillStyle = color; d.strokeStyle = ink('ink'); d.beginPath(); d.arc(...dotAt, 5, 0, 7); d.fill(); d.stroke();
    page('quat').textContent = 'q = (' + q.map(x => x.toFixed(4)).join(', ') + ')';
  }
  function graph(t, body, name) { plot(fit('graph'), [{ color: scene.color(body), x: both.map(([s]) => s), y: column(body, name) }], t, name); }
  // ---- ticks of events under the scrubber: by height and colour ----
  const styles = { impact: [1, okabeIto[4]], contact: [0.75, okabeIto[2]], slip: [0.5, okabeIto[0]], stick: [0.5, okabeIto[1]], liftoff: [0.75, okabeIto[5]], force: [0.35, okabeIto[3]], rest: [0.35, okabeIto[3]] };
  function ticks(t) {
    const { d, w, h, ink } = fit('ticks'), X = x => 8 + (w - 16) * (x - run.begin) / span;
    run.events.forEach(e => { const [tall, c] = styles[e.kind]; d.strokeStyle = c; d.lineWidth = 1.6; d.beginPath(); d.moveTo(X(e.t), h); d.lineTo(X(e.t), h - tall * (h - 2)); d.stroke(); });
    d.strokeStyle = ink('ink'); d.lineWidth = 1; d.beginPath(); d.moveTo(X(t), 0); d.lineTo(X(t), h); d.stroke();
  }
  return { quantities: Object.keys(quantities), energy, sphere, graph, ticks, view };
}
