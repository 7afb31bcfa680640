// What is told of the words and functions of a text. In: the compiler, which says where they stand; `words.json`, what is
// told of them. Out: both together.

import { Stopped } from "./workers.js";

/** What a word says in a block: the entry of that block, else the one of all others. */
function ofWord(words, block, word) {
  const known = words.filter((one) => one.word === word);
  const found = known.find(({ of }) => of.includes(block)) ?? known.find(({ of }) => of.length === 0);
  return found && { head: `${word}, in ${block}`, meaning: found.meaning, units: null, example: null };
}

export class Words {
  #compiler;
  #texts = null;
  /** The last text that was asked for, and where its words stand. */
  #last = { text: null, words: null };

  constructor(compiler) {
    this.#compiler = compiler;
  }

  /** What is told of the words of a text, with their bytes; nothing while the compiler is wanted for another one. */
  async told(text) {
    if (this.#last.text !== text) {
      const words = this.#compiler.ask({ ask: "words", text }).then(({ answer }) => answer.words);
      this.#last = { text, words };
    }
    this.#texts ??= fetch("words.json").then((response) => response.json());
    try {
      const [found, { words, functions }] = await Promise.all([this.#last.words, this.#texts]);
      return found.flatMap(({ bytes, block, word }) => {
        const told = block === null ? functions[word] : ofWord(words, block, word);
        return told ? [{ bytes, ...told }] : [];
      });
    } catch (fault) {
      this.#last = { text: null, words: null };
      if (fault instanceof Stopped) return [];
      throw fault;
    }
  }
}
