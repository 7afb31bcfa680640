// The editor.
// In: its element, what is told of changes, what tells of words. Out: its text, which can be set; faults at their places;
// what is told of the word under the pointer.

import { defaultKeymap, history, historyKeymap, indentWithTab } from "@codemirror/commands";
import { bracketMatching, indentOnInput, indentUnit, syntaxHighlighting } from "@codemirror/language";
import { lintGutter, lintKeymap, setDiagnostics } from "@codemirror/lint";
import { highlightSelectionMatches, searchKeymap } from "@codemirror/search";
import { EditorState, Transaction } from "@codemirror/state";
import { drawSelection, EditorView, highlightActiveLine, highlightActiveLineGutter, hoverTooltip, keymap, lineNumbers } from "@codemirror/view";
import { bond, colours } from "./colours.js";
import { element, withCode } from "./elements.js";

/** Where each byte of the text in UTF-8 stands in it, for those that are asked for in ascending order. */
function places(text) {
  let [byte, at] = [0, 0];
  return (wanted) => {
    if (wanted < byte) [byte, at] = [0, 0];
    while (byte < wanted && at < text.length) {
      const code = text.codePointAt(at);
      byte += code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
      at += code < 0x10000 ? 1 : 2;
    }
    return at;
  };
}

/** What has bytes of the text as what stands in it from where to where. */
export function placed(text, all) {
  const place = places(text);
  return all.map((one) => {
    const [from, to] = [place(one.bytes[0]), place(one.bytes[1])];
    return { ...one, from, to };
  });
}

/** What is told of a word, as a reader sees it. */
function told({ head, meaning, units, example }) {
  const more = units === null ? [] : [element("p", {}, "Units: ", ...withCode(units)), element("pre", {}, example)];
  return element("div", { class: "told" }, element("pre", {}, head), element("p", {}, ...withCode(meaning)), ...more);
}

export class Editor {
  #view;

  /** `changed` is called when the reader changes the text, `words` gives what is told of the words of one, as a promise. */
  constructor(parent, changed, words) {
    const listener = EditorView.updateListener.of((update) => {
      const isReaders = update.transactions.some((transaction) => transaction.annotation(Transaction.userEvent));
      if (update.docChanged && isReaders) changed();
    });
    this.extensions = [
      lineNumbers(),
      lintGutter(),
      history(),
      drawSelection(),
      bracketMatching(),
      indentOnInput(),
      indentUnit.of("    "),
      EditorState.tabSize.of(4),
      highlightActiveLine(),
      highlightActiveLineGutter(),
      highlightSelectionMatches(),
      hoverTooltip(
        async ({ state: { doc } }, at) => {
          const text = doc.toString();
          const word = placed(text, await words(text)).find(({ from, to }) => from <= at && at < to);
          return word ? { pos: word.from, end: word.to, above: true, create: () => ({ dom: told(word) }) } : null;
        },
        { hideOnChange: true },
      ),
      bond,
      syntaxHighlighting(colours),
      keymap.of([...defaultKeymap, ...searchKeymap, ...historyKeymap, ...lintKeymap, indentWithTab]),
      EditorView.contentAttributes.of({ "aria-label": "Text of the machine", autocapitalize: "off", spellcheck: "false" }),
      listener,
    ];
    this.#view = new EditorView({ parent, state: this.#state("") });
  }

  #state(text) {
    return EditorState.create({ doc: text, extensions: this.extensions });
  }

  get text() {
    return this.#view.state.doc.toString();
  }

  /** Another text; what was done to the one before cannot be undone in it. */
  set text(text) {
    this.#view.setState(this.#state(text));
  }

  /** Marks the faults. */
  mark(faults) {
    const { length } = this.#view.state.doc;
    const diagnostics = faults.map(({ from, to, code, message, help }) => ({
      from: Math.min(from, length),
      to: Math.min(Math.max(to, from + 1), length),
      severity: "error",
      source: code,
      message: help ? `${message}\n${help}` : message,
    }));
    this.#view.dispatch(setDiagnostics(this.#view.state, diagnostics));
  }

  /** Goes there. */
  select(from, to) {
    const { length } = this.#view.state.doc;
    const selection = { anchor: Math.min(from, length), head: Math.min(to, length) };
    this.#view.dispatch({ selection, effects: EditorView.scrollIntoView(selection.anchor, { y: "center" }) });
    this.#view.focus();
  }

  /** Types at a place, as a reader does: for tests. */
  type(from, to, insert) {
    this.#view.dispatch({ changes: { from, to, insert }, userEvent: "input.type" });
  }
}
