// Runs a module as a page does: `node live.js FILE.wasm < orders`, an order in each line; writes an answer in each.

import { readFileSync } from "node:fs";
import { answering } from "./src/module.js";

const { answer, functions } = await answering(await WebAssembly.compile(readFileSync(process.argv[2])));
for (const order of readFileSync(0, "utf8").split("\n").filter(Boolean)) {
  const begin = performance.now();
  const text = await answer(order);
  console.error(`${(performance.now() - begin).toFixed(1)} ms, ${text.length} characters, ${functions()} functions of machine code`);
  process.stdout.write(`${text}\n`);
}
