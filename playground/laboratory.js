// SPDX-License-Identifier: MIT
// The library in a worker of its own, so that the page stays awake and a script can be stopped. One script at a time; of those that
// come meanwhile the last is run.
const page = id => document.getElementById(id);
async function inflate(text) {
  const packed = new Blob([Uint8Array.from(atob(text), c => c.charCodeAt(0))]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Response(packed).arrayBuffer();
}
function makeLaboratory(done) {
  const source = URL.createObjectURL(new Blob([page('worker').textContent], { type: 'text/javascript' })), bytes = inflate(page('wasm').textContent);
  let worker = null, busy = false, next = null;
  const start = async () => {
    const mine = worker = new Worker(source);
    busy = true;
    mine.onmessage = ({ data }) => {
      if (mine !== worker) return;
      busy = false;
      if (!data.ready) done(data);
      if (data.broken) stop();
      else if (next) { const task = next; next = null; run(task); }
    };
    mine.onerror = e => { if (mine === worker) done({ error: 'the worker failed: ' + e.message, said: '' }); };
    const wasm = (await bytes).slice(0);
    if (mine === worker) mine.postMessage(wasm, [wasm]);
  };
  const run = task => { if (busy) next = task; else { busy = true; worker.postMessage(task); } };
  const stop = () => { worker.terminate(); next = null; start(); };
  start();
  return { run, stop };
}
// A run's page stands in a frame of its own; the moment and camera that its reader chose stay from run to run.
function showPage(place, bytes, address) {
  const old = place.querySelector('iframe'), frame = document.createElement('iframe'), url = URL.createObjectURL(new Blob([bytes], { type: 'text/html' }));
  frame.title = 'The run';
  frame.src = url + (address || '');
  place.replaceChildren(frame);
  if (old) URL.revokeObjectURL(old.src.split('#')[0]);
  return frame;
}
// What a test asks: the page's root element says what came of the last run.
function tellTest(result) {
  document.documentElement.dataset.report = JSON.stringify({ error: result.error || '', record: result.record ? result.record.length : 0, requests: performance.getEntriesByType('resource').filter(e => !e.name.startsWith('blob:')).length,
    summary: result.answer ? result.answer.summary || '' : '', number: result.answer && result.answer.page ? result.answer.page.number : null });
}
