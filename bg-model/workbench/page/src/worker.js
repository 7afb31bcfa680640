// The worker of a live page: the model runs here, so that the page stays quick.
// In: the module's bytes, then orders, each a text. Out: for each order `{ answer, milliseconds }` or `{ fault }`.

import { answering } from "./module.js";

let answer = null;

addEventListener("message", async ({ data }) => {
  try {
    if (answer === null) {
      answer = await answering(await WebAssembly.compile(data));
      return;
    }
    const begin = performance.now();
    const text = await answer(data);
    postMessage({ answer: text, milliseconds: performance.now() - begin });
  } catch (fault) {
    postMessage({ fault: `the model stopped: ${fault.message}` });
  }
});
