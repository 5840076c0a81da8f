// Writes the page into the crate: `node build.js`, or with --check compares it with the one that is there.

import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const out = join(here, "../host/src/view/page.html");
const read = (path) => readFileSync(join(here, path), "utf8");

/** Placeholders that hangpose replaces. */
const PLACEHOLDERS = ["__HANGPOSE_TITLE__", "__HANGPOSE_SCENE__"];

async function bundle(entry, loader) {
  const result = await build({
    entryPoints: [join(here, entry)],
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: ["es2022"],
    loader,
    charset: "utf8",
    legalComments: "none",
    logLevel: "warning",
  });
  return result.outputFiles[0].text.trim();
}

function fail(why) {
  console.error(`viewer: ${why}`);
  process.exit(1);
}

const licence = read("LICENSES/three.txt");
if (licence !== read("node_modules/three/LICENSE"))
  fail("LICENSES/three.txt is not the licence of node_modules/three: copy it");
if (licence.includes("--")) fail("the licence of three.js has two dashes, which end a comment of the page");

const script = await bundle("src/main.ts", {});
const style = await bundle("src/style.css", {});
if (/<\/script|<!--/i.test(script)) fail("the script contains </script or <!--, which end it early");
if (/<\/style/i.test(style)) fail("the style contains </style");

const parts = { "@THREE_LICENCE@": licence.trim(), "@STYLE@": style, "@SCRIPT@": script };
const page = read("src/page.html").replace(/@(?:THREE_LICENCE|STYLE|SCRIPT)@/g, (name) => parts[name]);
for (const placeholder of PLACEHOLDERS) {
  const times = page.split(placeholder).length - 1;
  if (times !== 1) fail(`the page contains ${placeholder} ${times} times, not once`);
}

if (process.argv.includes("--check")) {
  if (!existsSync(out) || readFileSync(out, "utf8") !== page) {
    fail("host/src/view/page.html is not what viewer/ builds: run `npm ci && npm run build` in viewer/ and commit it");
  }
} else {
  writeFileSync(out, page);
  console.log(`host/src/view/page.html: ${(page.length / 1000).toFixed(0)} kB`);
}
