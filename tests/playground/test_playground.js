// SPDX-License-Identifier: MIT
// The playground: what it computes is what the library computes here, and its pages work in a headless Chromium.
//   node test_playground.js TREE BUILD PAGES RUNNER CHROMIUM WORK      77: there are no pages (./run page makes them)
'use strict';
const fs = require('fs'), path = require('path'), assert = require('assert'), { execFileSync } = require('child_process');
const { open } = require('./browser.js');
const [tree, build, pages, runner, chromium, work] = process.argv.slice(2);
if (!fs.existsSync(path.join(pages, 'index.html'))) { console.log('no pages in ' + pages + ': ./run page makes them'); process.exit(77); }
fs.mkdirSync(work, { recursive: true });
const read = (...names) => fs.readFileSync(path.join(tree, ...names), 'utf8');
const openRecord = new Function(read('view', 'algebra.js') + read('view', 'record.js') + 'return openRecord;')();

// The largest difference at 101 times of places (of 1 m or their size) and orientations, and of velocities where they are asked for too.
function difference(a, b, what, end = Math.min(a.end, b.end)) {
  let worst = 0;
  for (let k = 0; k <= 100; k++) {
    const t = Math.min(a.begin + (end - a.begin) * k / 100, end);
    a.bodies.forEach((_, i) => {
      const s = a.state(i, t), u = b.state(i, t);
      what.forEach(w => s[w].forEach((x, c) => { worst = Math.max(worst, Math.abs(x - u[w][c]) / Math.max(1, ...s[w].map(Math.abs))); }));
    });
  }
  return worst;
}

// The record of a script, by the library here.
function native(script) {
  const out = path.join(work, 'native');
  fs.rmSync(out, { recursive: true, force: true });
  execFileSync(runner, ['--trust', script, '--record', '--quiet', '--out', out]);
  return openRecord(new Uint8Array(fs.readFileSync(path.join(out, fs.readdirSync(out).find(f => f.endsWith('.run'))))));
}

// The same scene at ten times its tolerance: what the run's own tolerance is worth at its end.
function coarser(script) {
  const other = path.join(work, 'coarser.lua');
  fs.writeFileSync(other, `local impact = require "impact"
local make = impact.scene
impact.scene = function(definition) definition.tolerance = 10 * (definition.tolerance or 1e-10) return make(definition) end
return dofile ${JSON.stringify(script)}`);
  return native(other);
}

// Every scene runs in WebAssembly, too. In closed form they differ by libm's last digits; what is integrated, by no more than its tolerance makes of
// it, or than the keys of two records may (their own tolerance, of a body's size and in rad, of each). Steps that held faces want choose their lengths by a rounding: their
// places agree to the error that the run itself declares, up to the first impact, from where on that grows.
async function agreement() {
  const closed = ['bouncing_ball', 'superball', 'bowling_ball', 't_handle', 'newtons_cradle', 'stack'];
  const wasmBinary = fs.readFileSync(path.join(build, 'playground.wasm')), make = require(path.join(build, 'playground.js'));
  for (const name of fs.readdirSync(path.join(tree, 'examples/scenes')).filter(f => f.endsWith('.lua')).map(f => f.slice(0, -4))) {
    const m = await make({ wasmBinary, print() {}, printErr() {} }), run = m.cwrap('playground_run', 'number', ['string', 'string', 'string']), answer = m.cwrap('playground_answer', 'string', []);
    const script = path.join(tree, 'examples/scenes', name + '.lua'), here = native(script);
    assert.strictEqual(run(name, fs.readFileSync(script, 'utf8'), ''), 0, answer());
    const at = m._playground_bytes(0), there = openRecord(m.HEAPU8.slice(at, at + m._playground_size(0)));
    const exact = closed.includes(name), declared = /leave places uncertain by ([0-9.e+-]+) m/.exec(JSON.parse(answer()).summary);
    const strikes = [here, there].flatMap(run => run.events.filter(e => e.kind === 'impact').map(e => e.t));
    const end = declared && strikes.length ? 0.99 * Math.min(...strikes) : undefined;
    const off = difference(here, there, exact ? ['x', 'q', 'v', 'w'] : declared ? ['x'] : ['x', 'q'], end);
    const bar = exact ? 1e-13 : declared ? 2 * declared[1] : Math.max(2 * here.head.tolerance, difference(here, coarser(script), ['x', 'q']));
    console.log(`${name}: WebAssembly and this machine differ by ${off.toExponential(1)} (bar ${bar.toExponential(1)}), events ${there.events.length} and ${here.events.length}`);
    assert(off <= bar, name);
    assert(!exact || here.events.length === there.events.length, name);
  }
  const m = await make({ wasmBinary, print() {}, printErr() {} }), run = m.cwrap('playground_run', 'number', ['string', 'string', 'string']);
  assert.strictEqual(run('wrong', 'return impact.scene {', ''), 1);
  assert.match(m.cwrap('playground_answer', 'string', [])(), /^wrong:1:/);
}

async function inBrowser() {
  const visit = async (name, hash, work) => {
    const b = await open(chromium, 'file://' + path.join(pages, name + '.html') + hash);
    try { await work(b, async () => JSON.parse(await b.until('document.documentElement.dataset.report', 60))); assert.deepStrictEqual(b.said, [], name); } finally { await b.close(); }
  };
  const again = b => b.ask('delete document.documentElement.dataset.report');
  await visit('index', '', async (b, report) => {
    let r = await report();
    assert.strictEqual(r.error, ''); assert.strictEqual(r.requests, 0); assert(r.record > 10000 && r.summary.startsWith('sphere_wall'));
    assert(await b.ask("!!document.querySelector('#see iframe')"), 'the run is shown');
    await again(b);
    await b.ask("document.getElementById('source').value = 'error \"</pre><b id=harm>\"'; document.getElementById('run').click()");
    r = await report();
    assert.match(r.error, /<b id=harm>/);
    assert(await b.ask("!document.getElementById('harm') && document.getElementById('said').textContent.includes('<b id=harm>')"), 'what a script says is text');
    await again(b);
    await b.ask("document.getElementById('source').value = 'while true do end'; document.getElementById('run').click()");
    await b.ask("document.getElementById('stop').click()");
    await b.ask("document.getElementById('source').value = 'print(1 + 1)'; document.getElementById('run').click()");
    r = await report();
    assert.strictEqual(r.error, '');
    assert.match(await b.ask("document.getElementById('said').textContent"), /^2/);
  });
  for (const file of fs.readdirSync(pages).filter(f => f !== 'index.html' && f.endsWith('.html'))) {
    const size = fs.statSync(path.join(pages, file)).size;
    assert(size <= 2e6, `${file}: ${size} bytes`);
    await visit(file.slice(0, -5), '', async (b, report) => {
      const first = await report();
      assert.strictEqual(first.error, ''); assert.strictEqual(first.requests, 0); assert(first.number, 'a number');
      assert(await b.ask("document.getElementById('formula').textContent.length > 20"), 'a formula');
      assert(await b.ask("!!document.querySelector('#see iframe, #see canvas')"), 'something is seen');
      await b.ask("document.querySelectorAll('#sliders input').forEach(i => { i.value = +i.min + 0.7 * (i.max - i.min); i.dispatchEvent(new Event('input')); })");
      // What is asked meanwhile is skipped, and the last of it is answered: then the number is another.
      const second = JSON.parse(await b.until(`(r => JSON.parse(r).number !== ${JSON.stringify(first.number)} && r)(document.documentElement.dataset.report)`));
      assert.strictEqual(second.error, '');
      console.log(`${file}: ${Math.round(size / 1000)} kB; ${first.number.split('\n')[0]}`);
    });
  }
}
agreement().then(inBrowser).then(() => { console.log('1 passed, 0 failed'); }, e => { console.error(e); process.exit(1); });
