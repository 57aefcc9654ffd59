// SPDX-License-Identifier: MIT
// node frames.js CHROMIUM PAGE...: what a frame of a run's page takes where a headless Chromium draws in software (SwiftShader), while it plays in a
// window of 1200 x 800: ms of the wall clock, and of the processors by all of the browser's processes (Linux), which is what it takes on a machine
// that does nothing else, or less: it draws on several. 1: one takes more than .3 s of them.
'use strict';
const fs = require('fs'), path = require('path'), { open } = require('../playground/browser.js');
const [chromium, ...pages] = process.argv.slice(2);
const play = "document.getElementById('rate').value = '0.01'; dispatchEvent(new KeyboardEvent('keydown', { key: ' ', cancelable: true }));";
const frames = `new Promise(done => { let n = 0, from = performance.now();
  const next = () => { const now = performance.now(); n++; now - from < 4000 ? requestAnimationFrame(next) : done([n, (now - from) / n]); };
  requestAnimationFrame(next); })`;

// Seconds of the processors that a process and all below it have had so far; NaN where the system does not tell.
function spent(root) {
  const own = new Map(), parent = new Map();
  for (const pid of fs.existsSync('/proc/self/stat') ? fs.readdirSync('/proc').filter(p => /^\d+$/.test(p)) : []) {
    try {
      const words = fs.readFileSync(`/proc/${pid}/stat`, 'utf8').replace(/^.*\) /, '').split(' ');
      parent.set(+pid, +words[1]); own.set(+pid, (+words[11] + +words[12]) / 100);
    } catch (gone) { continue; }
  }
  let sum = own.size ? 0 : NaN;
  own.forEach((s, pid) => { for (let p = pid; p > 1; p = parent.get(p)) if (p === root) { sum += s; break; } });
  return sum;
}

(async () => {
  let bad = 0;
  console.log('page,first_ms,frame_ms,processor_ms');
  for (const file of pages) {
    const begun = Date.now(), b = await open(chromium, 'file://' + path.resolve(file), [1200, 800]);
    try {
      await b.until("document.getElementById('clock').textContent !== ''");
      const first = Date.now() - begun;
      await b.ask(play);
      await new Promise(go => setTimeout(go, 2000)); // it finds its pace
      const from = spent(b.pid), [count, frame] = await b.ask(frames), worked = 1000 * (spent(b.pid) - from) / count;
      console.log(`${path.basename(file, '.html')},${first},${frame.toFixed(0)},${worked.toFixed(0)}`);
      bad += (worked || frame) > 300;
    } finally { await b.close(); }
  }
  process.exit(bad ? 1 : 0);
})();
