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

// The largest difference of places (of 1 m or their size), orientations and velocities at 101 times.
function difference(a, b) {
  let worst = 0;
  assert.strictEqual(a.events.length, b.events.length, 'events');
  for (let k = 0; k <= 100; k++) {
    const t = Math.min(a.begin + (a.end - a.begin) * k / 100, a.end, b.end);
    a.bodies.forEach((_, i) => {
      const s = a.state(i, t), u = b.state(i, t);
      ['x', 'q', 'v', 'w'].forEach(what => s[what].forEach((x, c) => { worst = Math.max(worst, Math.abs(x - u[what][c]) / Math.max(1, ...s[what].map(Math.abs))); }));
    });
  }
  return worst;
}

async function agreement() {
  const make = require(path.join(build, 'playground.js')), wasmBinary = fs.readFileSync(path.join(build, 'playground.wasm'));
  const m = await make({ wasmBinary, print() {}, printErr() {} }), run = m.cwrap('playground_run', 'number', ['string', 'string', 'string']), answer = m.cwrap('playground_answer', 'string', []);
  // In closed form: libm's last digits. By the integrator: its tolerance, 1e-10 a step, as it grows on the way.
  for (const [name, bar] of [['bouncing_ball', 1e-13], ['superball', 1e-13], ['bowling_ball', 1e-13], ['t_handle', 1e-13], ['newtons_cradle', 1e-13],
    ['turntable', 1e-9], ['sphere_wall', 1e-8], ['sphere_wall_spin', 1e-8], ['eulers_disk', 1e-6], ['two_spheres', 1e-7]]) {
    const script = path.join(tree, 'examples/scenes', name + '.lua');
    execFileSync(runner, [script, '--record', '--quiet', '--out', work]);
    assert.strictEqual(run(name, fs.readFileSync(script, 'utf8'), ''), 0, answer());
    const at = m._playground_bytes(0), here = new Uint8Array(fs.readFileSync(path.join(work, name + '.run')));
    const off = difference(openRecord(here), openRecord(m.HEAPU8.slice(at, at + m._playground_size(0))));
    console.log(`${name}: WebAssembly and this machine differ by ${off.toExponential(1)} (bar ${bar})`);
    assert(off <= bar, name);
  }
  assert.strictEqual(run('wrong', 'return impact.scene {', ''), 1);
  assert.match(answer(), /^wrong:1:/);
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
