// Builds page.html from the sources beside this file. Run by build.sh, which installs the packages of
// package-lock.json in the folder that NEEDLEWORK_MODULES names.
//
//   node build.js PAGE.html
import { createHash } from "node:crypto";
import { readFileSync, writeFileSync, existsSync, readdirSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import { fileURLToPath } from "node:url";

const here = path.dirname(fileURLToPath(import.meta.url));
const modules = path.join(process.env.NEEDLEWORK_MODULES, "node_modules");
const esbuild = createRequire(path.join(modules, "x.js"))("esbuild");

const read = (name) => readFileSync(path.join(here, name), "utf8");

async function bundle() {
  const result = await esbuild.build({
    absWorkingDir: here,
    entryPoints: ["src/main.js"],
    bundle: true,
    minify: true,
    write: false,
    metafile: true,
    format: "iife",
    target: ["chrome120", "firefox121", "safari17"],
    charset: "utf8",
    legalComments: "inline",
    nodePaths: [modules],
  });
  // "</script" in a text of the bundle would end it.
  const script = result.outputFiles[0].text.replaceAll("</script", "<\\/script");
  return { script, packages: packagesOf(result.metafile) };
}

// The packages that files of the bundle are from.
function packagesOf(metafile) {
  const [output] = Object.values(metafile.outputs);
  const names = Object.entries(output.inputs)
    .filter(([, { bytesInOutput }]) => bytesInOutput > 0)
    .map(([file]) => file.match(/node_modules\/((?:@[^/]+\/)?[^/]+)/)?.[1])
    .filter(Boolean);
  return [...new Set(names)].sort();
}

function licenceOf(name) {
  const folder = path.join(modules, name);
  const { version, license } = JSON.parse(readFileSync(path.join(folder, "package.json"), "utf8"));
  const file = readdirSync(folder).find((entry) => /^licen[cs]e/i.test(entry));
  const text = file && existsSync(path.join(folder, file)) ? readFileSync(path.join(folder, file), "utf8") : "";
  if (!text) throw new Error(`${name}: no file with its licence: expected LICENSE`);
  return `<h2>${escaped(`${name} ${version} (${license})`)}</h2>\n<pre>${escaped(text.trim())}</pre>`;
}

function escaped(text) {
  return text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
}

const { script, packages } = await bundle();
const hash = createHash("sha256").update(script).digest("base64");
const parts = {
  SCRIPT_HASH: `sha256-${hash}`,
  "/* STYLE */": read("style.css").trim(),
  "<!-- licences -->": packages.map(licenceOf).join("\n"),
  "/* SCRIPT */": script,
};
let page = read("template.html");
for (const [mark, text] of Object.entries(parts)) page = page.replace(mark, () => text);
writeFileSync(process.argv[2], page);
