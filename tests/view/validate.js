// SPDX-License-Identifier: MIT
// Khronos' validator (npm: gltf-validator) over .glb files: what it says of each; 1: an error, a warning or a hint.
'use strict';
const fs = require('fs'), path = require('path'), validator = require('gltf-validator');
(async () => {
  let bad = 0;
  for (const file of process.argv.slice(2)) {
    const bytes = fs.readFileSync(file), { issues } = await validator.validateBytes(new Uint8Array(bytes));
    console.log(`${path.basename(file)}: ${bytes.length} bytes, ${issues.numErrors} errors, ${issues.numWarnings} warnings, ${issues.numHints} hints`);
    issues.messages.slice(0, 3).forEach(m => console.log(`  ${m.code} ${m.pointer}: ${m.message}`));
    bad += issues.numErrors + issues.numWarnings + issues.numHints;
  }
  process.exit(bad ? 1 : 0);
})();
