// Bundles the page's script and style: `npm ci && npm run build` writes dist/; `npm run check` says whether dist/ is
// what the sources give. The licences of what is inside are in dist/THIRD-PARTY.txt, which the page shows.

import { build } from "esbuild";
import { bundle } from "./bundle.js";

const folder = new URL(".", import.meta.url).pathname;
await bundle(build, folder, { report: "src/report.js", plain: "src/plain.js", worker: "src/worker.js" });
