// The worker of a live page: the model runs here, so that the page stays quick.
// In: the module's bytes, then orders, each a text. Out: for each order `{ answer, milliseconds }` or `{ fault }`.

import { answering } from "./module.js";

/** What answers, as soon as it is compiled. */
let model = null;

addEventListener("message", async ({ data }) => {
  if (model === null) {
    model = WebAssembly.compile(data).then(answering);
    return;
  }
  try {
    const { answer } = await model;
    const begin = performance.now();
    const text = await answer(data);
    postMessage({ answer: text, milliseconds: performance.now() - begin });
  } catch (fault) {
    postMessage({ fault: `the model stopped: ${fault.message}` });
  }
});
