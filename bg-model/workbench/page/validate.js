// Holds a glTF file against the specification: `node validate.js FILE.glb`. Exit code 1 and the findings where there
// are any.

import { readFile } from "node:fs/promises";
import validator from "gltf-validator";

const report = await validator.validateBytes(new Uint8Array(await readFile(process.argv[2])));
const { numErrors, numWarnings, messages } = report.issues;
if (numErrors + numWarnings > 0) {
  console.log(JSON.stringify(messages, null, 2));
  process.exitCode = 1;
}
