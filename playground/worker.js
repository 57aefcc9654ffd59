// SPDX-License-Identifier: MIT
// Beside the page: first the module's bytes, then scripts { name, source, values }; each is answered with
// { error } or { answer, record, page, said }.
let module = null, said = '';
onmessage = async ({ data }) => {
  if (!module) {
    const put = text => { said = said.length < 20000 ? said + text + '\n' : said; };
    module = await makePlayground({ wasmBinary: data, print: put, printErr: put });
    postMessage({ ready: true });
    return;
  }
  said = '';
  const run = module.cwrap('playground_run', 'number', ['string', 'string', 'string']);
  const text = f => module.cwrap(f, 'string', [])();
  const kept = kind => { const size = module._playground_size(kind), at = module._playground_bytes(kind); return size ? module.HEAPU8.slice(at, at + size) : null; };
  try {
    const code = run(data.name, data.source, data.values);
    postMessage(code ? { error: text('playground_answer'), said } : { answer: JSON.parse(text('playground_answer')), record: kept(0), page: kept(1), said });
  } catch (e) { // the module is not whole any more
    postMessage({ error: 'the run ended: ' + (e && e.message || e), said, broken: true });
  }
};
