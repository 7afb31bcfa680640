// Bundles the page's script and style: `npm ci && npm run build` writes dist/; `npm run check` says whether dist/ is
// what the sources give. The licences of what is inside are in dist/THIRD-PARTY.txt, which the page shows.

import { readFile } from "node:fs/promises";
import { build } from "esbuild";

const folder = new URL(".", import.meta.url).pathname;
const { outputFiles } = await build({
  absWorkingDir: folder,
  entryPoints: { report: "src/main.js", worker: "src/worker.js" },
  outdir: "dist",
  bundle: true,
  minify: true,
  format: "iife",
  target: ["chrome110", "firefox115", "safari16"],
  charset: "ascii",
  legalComments: "none",
  write: false,
});

const { writeFile } = await import("node:fs/promises");
const checks = process.argv.includes("--check");
for (const { path, contents, text } of outputFiles) {
  if (!checks) await writeFile(path, contents);
  else if ((await readFile(path, "utf8").catch(() => "")) !== text) {
    console.error(`${path.slice(folder.length)} is not what the sources give: npm run build`);
    process.exitCode = 1;
  }
  console.log(`${path.slice(folder.length)}: ${contents.length} bytes`);
}
