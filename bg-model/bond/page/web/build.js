// Bundles the page's script and style: `npm ci && npm run build` writes dist/; `npm run check` says whether dist/ is
// what the sources give. The licences of what is inside are in dist/THIRD-PARTY.txt, to which the page has a link.

import { build } from "esbuild";
import { bundle } from "../../../workbench/page/bundle.js";

const folder = new URL(".", import.meta.url).pathname;
await bundle(build, folder, { page: "src/main.js", compiler: "src/compiler.js" });
