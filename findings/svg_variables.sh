#!/usr/bin/env bash
# @resvg/resvg-js 2.6.2 (npm, Linux x86-64, node 18 or newer).
#
# Guess: a reader that knows no variables of CSS passes over `fill:var(--a)` and keeps the declaration before it, as the standard of CSS asks for what is not
# understood. So `fill:#0f0;fill:var(--a)` is green everywhere.
# Seen: resvg takes the second one and paints black. A rule inside `@supports` it passes over, and keeps the attribute.
# Output seen:
#   two declarations: [0, 0, 0]
#   in @supports: [0, 255, 0]
# Fails where the first one is not black.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init -y > /dev/null
npm install --silent @resvg/resvg-js@2.6.2
node - <<'END'
const { Resvg } = require("@resvg/resvg-js");
const colour = (style) => {
  const svg = `<svg xmlns="http://www.w3.org/2000/svg" width="10" height="10"><style>${style}</style><rect fill="#0f0" width="10" height="10"/></svg>`;
  return [...new Resvg(svg).render().pixels.slice(0, 3)];
};
const two = colour("rect{fill:#0f0;fill:var(--a)}");
const inside = colour("@supports (fill:var(--a)){rect{fill:var(--a,#0f0)}}");
console.log("two declarations:", JSON.stringify(two).replaceAll(",", ", "));
console.log("in @supports:", JSON.stringify(inside).replaceAll(",", ", "));
if (two.join() !== "0,0,0" || inside.join() !== "0,255,0") process.exit(1);
END
