// SPDX-License-Identifier: MIT
// Figures of quat.plot, drawn here: a canvas of panels, flat ones (flat.js) and ones in space (space.js), which turn under the hand.
// A figure is { size, grid, title, subtitle, items: panels }, as page.lua puts it into JSON: numbers that are not finite are null.
const inks = { blue: '#0072b2', red: '#d55e00', green: '#009e73', orange: '#e69f00', purple: '#cc79a7', teal: '#56b4e9', grey: '#a0aec0', dark: '#2d3748', black: '#000000' };
const inkCycle = ['blue', 'red', 'green', 'orange', 'purple', 'teal'];
const inkOf = (name, fallback) => inks[name || fallback] || name;
const real = x => typeof x === 'number' && isFinite(x);
const isSpace = panel => panel.three || panel.items.some(i => i.kind === 'surface' || (i.kind === 'arrows' && i.items.length === 6) ||
  ((i.kind === 'line' || i.kind === 'points') && i.items.length === 3));
// Items with the colours that they get in turn, where they ask for none.
function colored(panel) {
  let count = 0;
  return panel.items.map(item => {
    const drawn = ['line', 'points', 'arrows', 'surface'].includes(item.kind) && !item.color && !item.front;
    return { ...item, ink: inkOf(item.color, drawn ? inkCycle[count++ % inkCycle.length] : 'dark'), items: item.items || [] };
  });
}
// The smallest and largest of what a panel holds along an axis; null: nothing.
function extentOf(panel, axis, positive) {
  let low = Infinity, high = -Infinity;
  const take = x => { if (real(x) && !(positive && x <= 0)) { low = Math.min(low, x); high = Math.max(high, x); } };
  panel.items.forEach(i => {
    if (i.kind === 'surface') i.items[axis].forEach(row => row.forEach(take));
    else if (i.kind === 'line' || i.kind === 'points') (i.items[axis] || []).forEach(take);
    else if (i.kind === 'arrows') i.items[axis].forEach((x, k) => { take(x); take(real(x) ? x + i.items[axis + i.items.length / 2][k] : x); });
  });
  return low <= high ? [low, high] : null;
}
// A step of 1, 2 or 5 times a power of ten that divides the span into about so many parts.
function niceStep(span, parts) {
  const power = 10 ** Math.floor(Math.log10(span / parts)), rest = span / parts / power;
  return (rest < 1.5 ? 1 : rest < 3.5 ? 2 : rest < 7.5 ? 5 : 10) * power;
}
const ticksOf = (low, high, step) => {
  const list = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) list.push(k * step === 0 ? 0 : +(k * step).toPrecision(12));
  return list;
};
// Where a panel stands, in parts of the figure from its upper left: its box (left, bottom, right, top), or its cell of the grid.
function placeOf(figure, panel, number, top) {
  if (panel.box) { const [l, b, r, t] = panel.box; return { x: l, y: 1 - t, w: r - l, h: t - b, exact: true }; }
  const count = figure.items.length, grid = figure.grid || (count > 1 ? [2, Math.floor((count + 1) / 2)] : [1, 1]);
  const [c, r, wide = 1, high = 1] = panel.at || [number % grid[0] + 1, Math.floor(number / grid[0]) + 1];
  return { x: (c - 1) / grid[0], y: top + (1 - top) * (r - 1) / grid[1], w: wide / grid[0], h: (1 - top) * high / grid[1], exact: false };
}
function letter(d, text, x, y, { size = 11, align = 'left', color = '#2d3748', bold = false, halo = false }) {
  d.font = `${bold ? 'bold ' : ''}${size * 4 / 3}px system-ui, 'DejaVu Sans', sans-serif`;
  d.textAlign = align; d.textBaseline = 'middle';
  if (halo) { d.lineWidth = 4; d.strokeStyle = '#ffffffcc'; d.lineJoin = 'round'; d.strokeText(text, x, y); }
  d.fillStyle = color; d.fillText(text, x, y);
}
// Lines of the legend: those items that have a label, in the corner that the panel names.
function legend(d, panel, items, x, y, w, h) {
  const place = panel.legend || 'top right', rows = items.filter(i => i.label && i.kind !== 'mark');
  if (place === 'none' || !rows.length) return;
  d.font = `14px system-ui, 'DejaVu Sans', sans-serif`;
  const wide = 46 + Math.max(...rows.map(r => d.measureText(r.label).width)), tall = 19 * rows.length, row = place === 'row';
  const left = place.includes('left') ? x + 8 : place.includes('right') || row ? x + w - wide - 8 : x + (w - wide) / 2;
  const first = place.includes('top') || row ? y + 12 : place.includes('bottom') ? y + h - tall - 2 : y + (h - tall) / 2;
  rows.forEach((item, k) => {
    const cx = row ? x + w - (rows.length - k) * (wide + 8) : left, cy = first + (row ? 0 : 19 * k);
    d.strokeStyle = d.fillStyle = item.ink; d.lineWidth = item.width || 2; d.setLineDash(item.dash ? [6, 4] : []);
    d.beginPath();
    if (item.kind === 'points') { d.arc(cx + 14, cy, 4, 0, 7); d.fill(); } else if (item.kind === 'surface') d.fillRect(cx + 2, cy - 5, 26, 10); else { d.moveTo(cx, cy); d.lineTo(cx + 30, cy); d.stroke(); }
    d.setLineDash([]);
    letter(d, item.label, cx + 38, cy, { size: 10.5 });
  });
}
// Draws all of it; views: by panel what hands have turned.
function drawFigure(canvas, figure, views) {
  const [W, H] = figure.size || [1280, 860], d = canvas.getContext('2d'), ratio = canvas.width / W;
  d.setTransform(ratio, 0, 0, ratio, 0, 0);
  d.fillStyle = '#ffffff'; d.fillRect(0, 0, W, H);
  let top = 0;
  if (figure.title) {
    letter(d, figure.title, W / 2, 25, { size: 16, align: 'center', color: '#1a202c' });
    if (figure.subtitle) letter(d, figure.subtitle, W / 2, 50, { align: 'center', color: '#4a5568' });
    top = (figure.subtitle ? 66 : 45) / H;
  }
  const boxes = figure.items.map((panel, k) => { const p = placeOf(figure, panel, k, top); return { x: p.x * W, y: p.y * H, w: p.w * W, h: p.h * H, exact: p.exact }; });
  // Panels in space of one range and one size get one scale, the smallest of theirs: found by drawing those once.
  const kinds = figure.items.map((p, k) => (isSpace(p) && p.equal && p.xrange && p.yrange && p.zrange ? JSON.stringify([p.xrange, p.yrange, p.zrange, Math.round(boxes[k].w), Math.round(boxes[k].h)]) : null));
  const shared = kinds.filter((kind, k) => kind && kinds.indexOf(kind) !== k), scales = {};
  const draw = (panel, k) => (isSpace(panel) ? drawSpace(d, panel, boxes[k], ratio, views[k], scales[kinds[k]] || 0) : drawFlat(d, panel, boxes[k]));
  figure.items.forEach((panel, k) => { if (shared.includes(kinds[k])) scales[kinds[k]] = Math.min(drawSpace(d, panel, boxes[k], ratio, views[k], 0), scales[kinds[k]] || Infinity); });
  figure.items.forEach(draw);
}
// A canvas for a figure; drag turns the panel in space under the hand. turned: views of another canvas of as many panels, or null.
function figureCanvas(figure, width, turned) {
  const canvas = document.createElement('canvas'), [W, H] = figure.size || [1280, 860];
  canvas.width = width || W; canvas.height = Math.round(canvas.width * H / W);
  canvas.setAttribute('role', 'img');
  canvas.setAttribute('aria-label', [figure.title || 'A figure', ...figure.items.map(p => p.title || '')].join('. '));
  const views = canvas.views = turned || figure.items.map(p => { const [x, z] = p.view || [65, 35]; return { yaw: (z - 90) * Math.PI / 180, pitch: (90 - x) * Math.PI / 180 }; });
  let held = null, waits = false;
  const draw = () => { waits = false; drawFigure(canvas, figure, views); };
  canvas.addEventListener('pointerdown', e => {
    const r = canvas.getBoundingClientRect(), x = (e.clientX - r.left) / r.width, y = (e.clientY - r.top) / r.height;
    const k = figure.items.findIndex((panel, i) => { const p = placeOf(figure, panel, i, figure.title ? 45 / H : 0); return isSpace(panel) && x > p.x && x < p.x + p.w && y > p.y && y < p.y + p.h; });
    held = k < 0 ? null : { k, x: e.clientX, y: e.clientY };
    if (held) canvas.setPointerCapture(e.pointerId);
  });
  canvas.addEventListener('pointermove', e => {
    if (!held) return;
    const view = views[held.k];
    view.yaw -= (e.clientX - held.x) * 0.008; view.pitch = clamp(view.pitch + (e.clientY - held.y) * 0.008, -1.55, 1.55);
    held.x = e.clientX; held.y = e.clientY;
    if (!waits) { waits = true; requestAnimationFrame(draw); }
  });
  ['pointerup', 'pointercancel'].forEach(k => canvas.addEventListener(k, () => { held = null; }));
  draw();
  return canvas;
}
function showFigures(place, figures) {
  place.replaceChildren(...figures.map(({ figure }) => { const c = figureCanvas(figure, 1600); c.style.flex = 'none'; c.style.height = 'auto'; return c; }));
  place.style.overflow = 'auto';
}
