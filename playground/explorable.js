// SPDX-License-Identifier: MIT
// An explorable: sliders over one script, which is run anew as they move; its formula, its number, and what is seen.
const content = JSON.parse(page('content').textContent), chosen = new URLSearchParams(location.hash.slice(1));
let views = null; // how the hand has turned the figure's panels
const laboratory = makeLaboratory(result => {
  page('said').textContent = result.said + (result.error || '');
  page('said').classList.toggle('failed', !!result.error);
  const it = result.answer && result.answer.page;
  if (it) {
    page('formula').textContent = it.formula; page('text').textContent = it.text; page('number').textContent = it.number;
    if (!page('sliders').firstChild) it.parameters.forEach(slider);
    if (result.page) showPage(page('see'), result.page, it.address);
    else if (it.figure) showFigure(it.figure);
  }
  tellTest(result);
});
function showFigure(figure) {
  const canvas = figureCanvas(figure, 1600, views);
  views = canvas.views;
  canvas.style.objectFit = 'contain';
  page('see').replaceChildren(canvas);
}
function run() {
  laboratory.run({ name: content.name, source: page('source').value, values: [...chosen].map(([k, v]) => `${k}=${v}`).join('\n') });
}
function slider(parameter) {
  const label = document.createElement('label'), input = document.createElement('input'), out = document.createElement('output');
  label.className = 'slider';
  Object.assign(input, { type: 'range', min: parameter.low, max: parameter.high, step: parameter.step || 'any', value: parameter.value });
  input.dataset.name = parameter.name;
  const say = () => { out.textContent = String(+(+input.value).toPrecision(4)); };
  input.addEventListener('input', () => { say(); chosen.set(parameter.name, input.value); history.replaceState(null, '', '#' + chosen); run(); });
  say();
  label.append(parameter.label, input, out);
  page('sliders').appendChild(label);
}
page('source').value = content.source;
page('run').addEventListener('click', run);
run();
