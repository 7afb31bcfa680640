// The worker: the compiler and the models run here, so that typing never waits. In: the compiled module, then questions
// `{ number, question, fresh }`, JSON texts of bond-page's `answers`. Out: for each `{ number, answer, milliseconds,
// functions }`, the functions of machine code that have been made, or `{ number, fault }`. A fresh instance answers a fresh question: what the compiler remembers of a text ends with
// the instance.

import { answering } from "../../../../workbench/page/src/module.js";

let module = null;
/** What answers, in the instance of the last fresh question. */
let answers = null;

addEventListener("message", async ({ data }) => {
  if (module === null) {
    module = data;
    return;
  }
  const { number, question, fresh } = data;
  try {
    const begin = performance.now();
    if (fresh || answers === null) answers = answering(module);
    const { answer, functions } = await answers;
    const text = await answer(question);
    postMessage({ number, answer: text, milliseconds: performance.now() - begin, functions: functions() });
  } catch (fault) {
    answers = null;
    postMessage({ number, fault: fault.message });
  }
});
