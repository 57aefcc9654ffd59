// SPDX-License-Identifier: MIT
// A headless Chromium on a pipe, without a library: open(url) gives { ask(expression), until(expression), send(method), picture, said, close, pid }.
'use strict';
const { spawn } = require('child_process');
const fs = require('fs'), os = require('os'), path = require('path');
async function open(chromium, url, size = [1400, 800]) {
  const profile = fs.mkdtempSync(path.join(os.tmpdir(), 'browser-'));
  const child = spawn(chromium, ['--headless', '--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--hide-scrollbars', '--remote-debugging-pipe', '--user-data-dir=' + profile,
    `--window-size=${size[0]},${size[1]}`, 'about:blank'], { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] });
  const waiting = new Map(), said = [];
  let number = 0, rest = '', session;
  child.stdio[4].on('data', bytes => {
    const parts = (rest + bytes).split('\0');
    rest = parts.pop();
    for (const part of parts) {
      const m = JSON.parse(part);
      if (m.id) { const [good, bad] = waiting.get(m.id); waiting.delete(m.id); m.error ? bad(Error(m.error.message)) : good(m.result); }
      else if (m.method === 'Runtime.consoleAPICalled') said.push(m.params.args.map(a => a.value || a.description).join(' '));
      else if (m.method === 'Runtime.exceptionThrown') said.push(m.params.exceptionDetails.exception ? m.params.exceptionDetails.exception.description : m.params.exceptionDetails.text);
      else if (m.method === 'Log.entryAdded' && m.params.entry.level === 'error') said.push(m.params.entry.text);
    }
  });
  const send = (method, params = {}) => new Promise((good, bad) => {
    waiting.set(++number, [good, bad]);
    child.stdio[3].write(JSON.stringify({ id: number, method, params, ...(session ? { sessionId: session } : {}) }) + '\0');
  });
  const { targetInfos } = await send('Target.getTargets');
  session = (await send('Target.attachToTarget', { targetId: targetInfos.find(t => t.type === 'page').targetId, flatten: true })).sessionId;
  for (const domain of ['Runtime', 'Log', 'Page']) await send(domain + '.enable');
  await send('Page.navigate', { url });
  const ask = async expression => {
    const answer = await send('Runtime.evaluate', { expression, returnByValue: true, awaitPromise: true });
    if (answer.exceptionDetails) throw Error(answer.exceptionDetails.exception.description);
    return answer.result.value;
  };
  const until = async (expression, seconds = 60) => {
    for (let i = 0; i < seconds * 10; i++) {
      const value = await ask(expression).catch(() => null);
      if (value) return value;
      await new Promise(go => setTimeout(go, 100));
    }
    throw Error('in vain waited for ' + expression + '; said: ' + said.join('\n'));
  };
  const picture = async file => fs.writeFileSync(file, Buffer.from((await send('Page.captureScreenshot', { format: 'png' })).data, 'base64'));
  const close = async () => {
    const ended = new Promise(go => child.on('exit', go));
    session = undefined;
    send('Browser.close').catch(() => {});
    await ended;
    fs.rmSync(profile, { recursive: true, force: true });
  };
  return { ask, until, picture, said, close, send, pid: child.pid };
}
module.exports = { open };
