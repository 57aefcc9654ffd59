// SPDX-License-Identifier: MIT
// The editor: a script, run by the library in this page.
const content = JSON.parse(page('content').textContent);
const laboratory = makeLaboratory(result => {
  page('stop').disabled = true;
  page('said').classList.toggle('failed', !!result.error);
  page('said').textContent = result.said + (result.error || (result.answer && result.answer.summary) || 'done');
  [['record', 'application/octet-stream'], ['page', 'text/html']].forEach(([kind, type]) => {
    const link = page(kind);
    if (link.href) URL.revokeObjectURL(link.href);
    link.hidden = !result[kind];
    if (result[kind]) link.href = URL.createObjectURL(new Blob([result[kind]], { type }));
  });
  if (result.page) showPage(page('see'), result.page);
  else if (!result.error && result.answer.figures.length) showFigures(page('see'), result.answer.figures);
  tellTest(result);
});
function run() {
  page('said').textContent = 'runs …';
  page('stop').disabled = false;
  laboratory.run({ name: page('example').value, source: page('source').value, values: '' });
}
content.examples.forEach(({ name }) => { const o = document.createElement('option'); o.textContent = name; page('example').appendChild(o); });
function choose(name) {
  const example = content.examples.find(e => e.name === name) || content.examples[0];
  page('example').value = example.name;
  page('source').value = example.source;
}
page('example').addEventListener('change', () => { choose(page('example').value); location.hash = 'example=' + page('example').value; run(); });
page('run').addEventListener('click', run);
page('stop').addEventListener('click', () => { laboratory.stop(); page('said').textContent = 'stopped'; page('stop').disabled = true; });
page('source').addEventListener('keydown', e => {
  if (e.key === 'Enter' && (e.ctrlKey || e.metaKey)) { e.preventDefault(); run(); }
});
const words = new URLSearchParams(location.hash.slice(1));
choose(words.get('example') || 'sphere_wall');
if (words.has('source')) page('source').value = words.get('source');
run();
