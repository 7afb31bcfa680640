// Bundles scripts and styles of a page into its folder dist/, or with `--check` says whether dist/ is what the sources
// give. In: esbuild's `build`, the page's folder, its entry points.

import { readFile, writeFile } from "node:fs/promises";

export async function bundle(build, folder, entryPoints) {
  const { outputFiles } = await build({
    absWorkingDir: folder,
    entryPoints,
    outdir: "dist",
    bundle: true,
    minify: true,
    format: "iife",
    target: ["chrome110", "firefox115", "safari16"],
    charset: "ascii",
    legalComments: "none",
    write: false,
  });
  const checks = process.argv.includes("--check");
  for (const { path, contents, text } of outputFiles) {
    if (!checks) await writeFile(path, contents);
    else if ((await readFile(path, "utf8").catch(() => "")) !== text) {
      console.error(`${path.slice(folder.length)} is not what the sources give: npm run build`);
      process.exitCode = 1;
    }
    console.log(`${path.slice(folder.length)}: ${contents.length} bytes`);
  }
}
