// SPDX-License-Identifier: MIT
// node assemble.js TREE BUILD OUT: the pages of the playground, each one file that needs nothing else.
'use strict';
const fs = require('fs'), path = require('path'), zlib = require('zlib');
const [tree, build, out] = process.argv.slice(2);
const read = (...names) => fs.readFileSync(path.join(tree, ...names), 'utf8');
const scripts = (folder, names) => names.map(n => read(folder, n + '.js').split('\n').filter(l => !/^\s*\/\//.test(l)).join('\n')).join('\n');
const wasm = zlib.deflateSync(fs.readFileSync(path.join(build, 'playground.wasm')), { level: 9 }).toString('base64');
const worker = fs.readFileSync(path.join(build, 'playground.js'), 'utf8') + '\n' + read('playground', 'worker.js');
if (worker.includes('</script')) throw Error('the worker would end the page');
// JSON in a page: nothing in it may end the element that holds it.
const inPage = value => JSON.stringify(value).replace(/</g, '\\u003c');
function write(name, title, main, content, names) {
  const may = " 'wasm-unsafe-eval' blob:; worker-src blob:; frame-src blob:", parts = { HEAD: read('view', 'head.html').replace('@TITLE@', title).replace('@MAY@', may), STYLE: read('playground', 'page.css'), MAIN: main, WORKER: worker, WASM: wasm, CONTENT: inPage(content),
    SCRIPT: scripts('view', ['algebra', 'mesh', 'gl', 'figure', 'flat', 'space', 'space_draw']) + '\n' + scripts('playground', ['laboratory', ...names]) };
  const text = read('playground', 'page.html').replace(/@([A-Z]+)@/g, (_, key) => parts[key]);
  fs.mkdirSync(out, { recursive: true });
  fs.writeFileSync(path.join(out, name + '.html'), text);
  console.log(`${path.join(out, name + '.html')}: ${Math.round(text.length / 1000)} kB`);
}
const luas = folder => fs.readdirSync(path.join(tree, folder)).filter(f => f.endsWith('.lua')).sort().map(f => ({ name: f.slice(0, -4), source: read(folder, f) }));
// What needs GSL is not in these pages: its licence would be theirs.
const uses_gsl = ({ source }) => /quat\.(curve|surface)/.test(source);
const links = [];
for (const e of luas('playground/explorables')) {
  const title = /title = "([^"]+)",\n  formula/.exec(e.source)[1];
  write(e.name, title, read('playground', 'explorable.html').replace('@TITLE@', title), e, ['explorable']);
  links.push(`<a href="${e.name}.html">${title}</a>`);
}
write('index', 'Playground', read('playground', 'editor.html').replace('@LINKS@', links.join(' · ')),
  { examples: [...luas('examples/scenes'), ...luas('examples/figures').filter(e => !uses_gsl(e))] }, ['editor']);
