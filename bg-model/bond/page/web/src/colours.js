// The colours of the language, from the grammar that editors have: a test holds its words against the compiler's.
// In: docs/editor/bond.tmLanguage.json. Out: a language for CodeMirror, and the colours.
// Method: of the grammar's patterns the one that matches first in the rest of a line has the next words, as TextMate
// has it. Blocks are left out: what is in them is what is outside.

import { HighlightStyle, StreamLanguage } from "@codemirror/language";
import { tags } from "@lezer/highlight";
import grammar from "../../../../../docs/editor/bond.tmLanguage.json";

/** A tag for each beginning of a scope's name; the first that fits. */
const TAGS = [
  ["comment", "comment"],
  ["keyword.other.clause", "modifier"],
  ["keyword.operator", "operator"],
  ["keyword", "keyword"],
  ["storage.modifier", "keyword"],
  ["storage.type", "atom"],
  ["constant.numeric", "number"],
  ["constant.language", "atom"],
  ["entity.name.type", "typeName"],
  ["variable.other.definition", "variableName.definition"],
  ["variable.language", "variableName.standard"],
  ["variable.other.member", "propertyName"],
  ["support.type.unit", "unit"],
  ["support.type", "typeName"],
  ["support.function", "variableName.function"],
  ["string", "string"],
];

function tagOf(scope) {
  return TAGS.find(([beginning]) => scope.startsWith(beginning))?.[1] ?? null;
}

/** The grammar's patterns in their order, those of comments over several lines and of blocks left out. */
function patterns({ patterns: list, repository }) {
  const flat = (all) =>
    all.flatMap((pattern) => {
      if (pattern.include) return pattern.include === "#block" ? [] : flat(repository[pattern.include.slice(1)].patterns);
      if (!pattern.match) return [];
      const captures = Object.entries(pattern.captures ?? {}).map(([index, { name }]) => [Number(index), tagOf(name)]);
      return [{ expression: new RegExp(pattern.match, "dg"), tag: pattern.name && tagOf(pattern.name), captures }];
    });
  return flat(list);
}

const PATTERNS = patterns(grammar);
const OPEN = /\/\*/g;
const CLOSE = /\*\//g;

function first(expression, line, from) {
  expression.lastIndex = from;
  return expression.exec(line);
}

/** The parts of a line, each with its end and its tag, and whether a comment goes on after it. */
export function partsOf(line, inComment) {
  const parts = [];
  let at = 0;
  const until = (end, tag) => {
    if (end > at) parts.push({ end, tag });
    at = Math.max(at, end);
  };
  let comment = inComment;
  while (at < line.length) {
    if (comment) {
      const close = first(CLOSE, line, at);
      until(close === null ? line.length : close.index + 2, "comment");
      comment = close === null;
      continue;
    }
    const found = PATTERNS.map((pattern) => ({ pattern, match: first(pattern.expression, line, at) }));
    const matching = found.filter(({ match }) => match !== null && match[0].length > 0);
    const next = matching.reduce((a, b) => (a === null || b.match.index < a.match.index ? b : a), null);
    const open = first(OPEN, line, at);
    if (open !== null && (next === null || open.index < next.match.index)) {
      until(open.index, null);
      comment = true;
    } else if (next === null) {
      until(line.length, null);
    } else {
      const { match, pattern } = next;
      until(match.index, null);
      for (const [index, tag] of pattern.captures) {
        const [start, end] = match.indices[index] ?? [0, 0];
        until(start, pattern.tag);
        until(end, tag);
      }
      until(match.index + match[0].length, pattern.tag);
    }
  }
  return { parts, comment };
}

export const bond = StreamLanguage.define({
  name: "bond",
  languageData: { commentTokens: { line: "//", block: { open: "/*", close: "*/" } }, closeBrackets: { brackets: ["(", "[", "{"] } },
  startState: () => ({ comment: false, parts: [], index: 0 }),
  copyState: (state) => ({ ...state }),
  token(stream, state) {
    if (stream.sol()) Object.assign(state, partsOf(stream.string, state.comment), { index: 0 });
    const part = state.parts[state.index];
    state.index += 1;
    if (part === undefined) stream.skipToEnd();
    else stream.pos = part.end;
    return part?.tag ?? null;
  },
  // A block's lines stand four blanks further in than the block.
  indent(state, after, { unit, state: { doc }, pos }) {
    const before = doc.lineAt(Math.max(doc.lineAt(pos).from - 1, 0)).text;
    const own = before.length - before.trimStart().length;
    const opens = /[{(\[]\s*(\/\/.*)?$/.test(before) ? unit : 0;
    return Math.max(own + opens - (/^\s*[})\]]/.test(after) ? unit : 0), 0);
  },
});

const colour = (tag, name, more = {}) => ({ tag, color: `var(--${name})`, ...more });
export const colours = HighlightStyle.define([
  colour(tags.comment, "pencil", { fontStyle: "italic" }),
  colour(tags.keyword, "hue-0"),
  colour(tags.modifier, "hue-5"),
  colour(tags.atom, "hue-3"),
  colour(tags.number, "hue-1"),
  colour(tags.unit, "hue-2"),
  colour(tags.string, "hue-2"),
  colour(tags.typeName, "hue-4", { fontWeight: "600" }),
  colour(tags.operator, "pencil"),
  colour(tags.function(tags.variableName), "hue-4"),
  colour(tags.standard(tags.variableName), "hue-3"),
  colour(tags.definition(tags.variableName), "ink", { fontWeight: "600" }),
]);
