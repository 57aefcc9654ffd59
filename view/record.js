// SPDX-License-Identifier: MIT
// A recorded run as a source: { head, bodies, begin, end, events, contacts, account, state(body, t, before), times(body) } (docs/run.md).
function openRecord(bytes) {
  const end = bytes.indexOf(10) + 1;
  const head = JSON.parse(new TextDecoder().decode(bytes.subarray(0, end)));
  const tables = {};
  for (const [name, table] of Object.entries(head.tables)) {
    const width = table.columns.length, data = new Float64Array(bytes.buffer, bytes.byteOffset + end + table.at, table.rows * width);
    tables[name] = { rows: table.rows, get: (row, column) => data[row * width + table.columns.indexOf(column)],
      list: (row, columns) => columns.map(c => data[row * width + table.columns.indexOf(c)]) };
  }
  const keys = tables.keys, X = ['x', 'y', 'z'], Q = ['qw', 'qx', 'qy', 'qz'], N = ['nx', 'ny', 'nz'], P = ['px', 'py', 'pz'];
  const rate = (w, q) => scale(qmul([0, ...w], q), 0.5);
  const key = row => {
    const q = keys.list(row, Q), w = keys.list(row, ['wx', 'wy', 'wz']), dw = keys.list(row, ['dwx', 'dwy', 'dwz']), q1 = rate(w, q);
    return { t: keys.get(row, 't'), x: keys.list(row, X), v: keys.list(row, ['vx', 'vy', 'vz']), a: keys.list(row, ['ax', 'ay', 'az']),
      q, w, q1, q2: add(rate(dw, q), rate(w, q1)), dw, form: head.forms[keys.get(row, 'form')] };
  };
  // What one key says alone: a parabola, turned about one axis.
  const steady = (k, T) => {
    const turn = scale(add(k.w, scale(k.dw, T / 2)), T), angle = norm(turn), s = angle > 0 ? Math.sin(angle / 2) / angle : 0.5;
    return { x: add(k.x, scale(add(k.v, scale(k.a, T / 2)), T)), v: add(k.v, scale(k.a, T)), w: add(k.w, scale(k.dw, T)),
      q: unit(qmul([Math.cos(angle / 2), ...scale(turn, s)], k.q)) };
  };
  const bodies = head.bodies.map(b => {
    const list = Array.from({ length: b.keys[1] }, (_, i) => key(b.keys[0] + i));
    return { ...b, list, turn: b.shape_orientation || [1, 0, 0, 0], offset: b.shape_position || [0, 0, 0], trail: b.trail || [0, 0, 0] };
  });
  // f and f' at part s of h: the quintic Hermite polynomial of f, f', f'' at both ends.
  const quintic = (f0, d0, c0, f1, d1, c1, h, s) => {
    const r = 1 - s, ss = s * s, e = ss * s * (10 - s * (15 - 6 * s)), de = 30 * ss * r * r / h;
    const a = h * s * (1 - ss * (6 - s * (8 - 3 * s))), da = 1 - ss * (18 - s * (32 - 15 * s));
    const b = h * h * ss * r * r * r / 2, db = h * s * r * r * (2 - 5 * s) / 2;
    const c = h * ss * s * (-4 + s * (7 - 3 * s)), dc = ss * (-12 + s * (28 - 15 * s));
    const d = h * h * ss * s * r * r / 2, dd = h * ss * r * (3 - 5 * s) / 2;
    const mix = (e, a, b, c, d) => f0.map((_, i) => e * (f1[i] - f0[i]) + a * d0[i] + b * c0[i] + c * d1[i] + d * c1[i]);
    return [add(f0, mix(e, a, b, c, d)), mix(de, da, db, dc, dd)];
  };
  const state = (i, t, before) => {
    const list = bodies[i].list;
    let low = 0, high = list.length;
    while (low < high) {
      const m = (low + high) >> 1;
      if (list[m].t < t || (!before && list[m].t === t)) low = m + 1; else high = m;
    }
    const next = Math.max(low, 1), a = list[next - 1], b = list[next];
    if (!b || t <= a.t) return { x: a.x, q: a.q, v: a.v, w: a.w };
    if (a.form === 'steady') return steady(a, t - a.t);
    if (t >= b.t) return { x: b.x, q: b.q, v: b.v, w: b.w };
    const h = b.t - a.t, s = (t - a.t) / h, [x, v] = quintic(a.x, a.v, a.a, b.x, b.v, b.a, h, s);
    const [p, dp] = quintic(a.q, a.q1, a.q2, b.q, b.q1, b.q2, h, s);
    return { x, v, q: unit(p), w: scale(qmul(dp, conj(p)).slice(1), 2 / dot(p, p)) };
  };
  // Times by which a body's turning is drawn with straight lines: from key to key in parts of a tenth of a radian.
  const times = i => bodies[i].list.flatMap((k, j, list) => {
    const T = list[j + 1] ? list[j + 1].t - k.t : 0, turn = T * Math.max(norm(k.w), T > 0 ? norm(list[j + 1].w) : 0), parts = clamp(Math.ceil(10 * turn), 1, 4000);
    return Array.from({ length: parts }, (_, s) => k.t + T * s / parts);
  });
  const name = i => i < 0 ? '' : bodies[i].name;
  const events = Array.from({ length: tables.events.rows }, (_, row) => {
    const e = tables.events, n = e.list(row, N), [body1, body2, force] = e.list(row, ['body1', 'body2', 'force']);
    return { t: e.get(row, 't'), kind: head.kinds[e.get(row, 'kind')], body1, body2, name1: name(body1), point: e.list(row, P), n,
      name2: force >= 0 ? head.forces[force] : name(body2), impulse: e.list(row, ['jx', 'jy', 'jz']), phases: head.phases[e.get(row, 'phases')] };
  });
  const contacts = new Map(); // of each pair its patches: rows of one time are points of one
  for (let row = 0; row < tables.contacts.rows; row++) {
    const c = tables.contacts, [t, body1, body2, mode] = c.list(row, ['t', 'body1', 'body2', 'mode']), pair = body1 + ' ' + body2;
    if (!contacts.has(pair)) contacts.set(pair, []);
    const list = contacts.get(pair), last = list[list.length - 1], at = { x: c.list(row, P), force: c.list(row, ['fx', 'fy', 'fz']) };
    if (last && last.t === t && last.mode !== 'open' && head.modes[mode] !== 'open') last.at.push(at);
    else list.push({ t, body1, mode: head.modes[mode], n: c.list(row, N), at: [at] });
  }
  // The contacts held at t, between rows of as many points by straight lines: points, all of their force, and where it acts.
  const held = t => [...contacts.values()].flatMap(rows => {
    const next = rows.findIndex(r => r.t > t), i = (next < 0 ? rows.length : next) - 1, a = rows[i], b = rows[i + 1];
    if (!a || a.mode === 'open') return [];
    const like = b && b.mode !== 'open' && b.at.length === a.at.length, s = like ? (t - a.t) / (b.t - a.t) : 0;
    const mix = k => a.at.map((p, j) => (like ? add(p[k], scale(sub(b.at[j][k], p[k]), s)) : p[k])), points = mix('x'), forces = mix('force');
    const force = forces.reduce(add), total = forces.reduce((sum, f) => sum + norm(f), 0) || 1;
    const point = points.map((x, j) => scale(x, norm(force) > 0 ? norm(forces[j]) / total : 1 / points.length)).reduce(add);
    return [{ mode: a.mode, body1: a.body1, n: a.n, points, point, force }];
  });
  const A = tables.account, losses = ['damping_loss', 'sliding_loss', 'impact_loss'];
  const account = Array.from({ length: A.rows }, (_, row) => ({ t: A.get(row, 't'), E: A.get(row, 'kinetic') + A.get(row, 'potential'),
    kinetic: A.get(row, 'kinetic'), potential: A.get(row, 'potential'), losses: A.list(row, losses) }));
  const ends = bodies.flatMap(b => [b.list[0].t, b.list[b.list.length - 1].t]);
  return { head, bodies, events, held, account, state, times, begin: Math.min(...ends), end: Math.max(...ends) };
}
