// What VS Code's own engine makes of a text: each word with its scopes, a JSON array a line, then the scopes that are left open.
//
//     node colours.js FOLDER GRAMMARS SCOPE FILE
//
// FOLDER has node_modules with vscode-textmate and vscode-oniguruma, GRAMMARS is docs/editor, SCOPE source.bond or source.rust, of
// which there is an empty grammar here: colours of Rust are not ours.

const fs = require("fs");
const path = require("path");

const [folder, grammars, scope, file] = process.argv.slice(2);
const modules = path.join(folder, "node_modules");
const { INITIAL, Registry, parseRawGrammar } = require(path.join(modules, "vscode-textmate"));
const oniguruma = require(path.join(modules, "vscode-oniguruma"));

const RUST = { scopeName: "source.rust", patterns: [{ name: "comment.line.rust", match: "//.*$" }, { begin: "\\{", end: "\\}", patterns: [{ include: "$self" }] }] };
const FILES = { "source.bond": "bond.tmLanguage.json", "source.bond.in-rust": "bond-in-rust.tmLanguage.json" };

async function main() {
  await oniguruma.loadWASM(fs.readFileSync(path.join(modules, "vscode-oniguruma/release/onig.wasm")));
  const registry = new Registry({
    onigLib: Promise.resolve({
      createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
      createOnigString: (text) => new oniguruma.OnigString(text),
    }),
    getInjections: (name) => (name === "source.rust" ? ["source.bond.in-rust"] : []),
    loadGrammar: async (name) => {
      if (name === RUST.scopeName) return RUST;
      const grammar = path.join(grammars, FILES[name]);
      return parseRawGrammar(fs.readFileSync(grammar, "utf8"), grammar);
    },
  });
  const grammar = await registry.loadGrammar(scope);
  let open = INITIAL;
  const lines = fs.readFileSync(file, "utf8").split("\n");
  lines.forEach((line, index) => {
    const { tokens, ruleStack } = grammar.tokenizeLine(line, open);
    open = ruleStack;
    for (const { startIndex, endIndex, scopes } of tokens) {
      const word = line.slice(startIndex, endIndex).trim();
      if (word) console.log(JSON.stringify([index + 1, word, scopes.slice(1)]));
    }
  });
  console.log(JSON.stringify(open.depth));
}

main();
