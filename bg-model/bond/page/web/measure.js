// How long the module's answers take in node, and how large it is: `node measure.js FOLDER`, the folder of the page.
// The first time each function is compiled as it is called, later the engine has better code.

import { readFileSync } from "node:fs";
import { brotliCompressSync, constants, gzipSync } from "node:zlib";
import { answering } from "../../../workbench/page/src/module.js";

const file = (name) => readFileSync(`${process.argv[2]}/${name}`);
const COUNT = 100_000;

const bytes = file("bond.wasm");
const gzip = gzipSync(bytes, { level: 9 }).length;
const brotli = brotliCompressSync(bytes, { params: { [constants.BROTLI_PARAM_LGWIN]: 24 } }).length;
console.log(`bond.wasm: ${bytes.length} bytes, gzip ${gzip}, brotli ${brotli}`);

const examples = JSON.parse(file("examples.json"));
const module = await WebAssembly.compile(bytes);
for (const name of ["first", "hacksaw"]) {
  const { text, scene } = examples.find((example) => example.name === name);
  const times = { compile: [], report: [], rate: [] };
  for (let round = 0; round < 5; round += 1) {
    const { answer } = await answering(module);
    const asked = async (question) => {
      const begin = performance.now();
      const told = JSON.parse(await answer(JSON.stringify(question)));
      if (told.fault) throw new Error(told.fault);
      times[question.ask].push(performance.now() - begin);
    };
    await asked({ ask: "compile", text, graph: null, scene });
    await asked({ ask: "report" });
    await asked({ ask: "rate", count: COUNT });
  }
  const told = ([first, ...rest]) => `${first.toFixed(0)} ms at first, then ${Math.min(...rest).toFixed(0)}`;
  const rate = (1e6 * Math.min(...times.rate)) / COUNT;
  console.log(`${name}: compiled in ${told(times.compile)}; report in ${told(times.report)}; a rate in ${rate.toFixed(0)} ns`);
}
