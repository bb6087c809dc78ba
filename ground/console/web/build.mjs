// Builds the page: messages from their .proto files, then one script, one worker and one style sheet.
//   node build.mjs [--out FOLDER] [--generate-only]
import { createHash } from "node:crypto";
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { parseArgs } from "node:util";

const here = dirname(fileURLToPath(import.meta.url));
const { values } = parseArgs({
  options: {
    out: { type: "string", default: join(here, "dist") },
    root: { type: "string", default: resolve(here, "../../..") },
    "generate-only": { type: "boolean", default: false },
  },
});

const generated = join(here, "src", "gen");
rmSync(generated, { recursive: true, force: true });
mkdirSync(generated, { recursive: true });
execFileSync("protoc", [
  `--plugin=protoc-gen-es=${join(here, "node_modules/.bin/protoc-gen-es")}`,
  `--es_out=${generated}`, "--es_opt=target=ts", `-I${join(values.root, "ground/console")}`, `-I${join(values.root, "ground/measuring")}`, "live.proto", "measuring.proto",
], { stdio: "inherit" });
if (values["generate-only"]) process.exit(0);

const esbuild = await import("esbuild");
rmSync(values.out, { recursive: true, force: true });
mkdirSync(values.out, { recursive: true });
const common = {
  bundle: true, minify: true, format: "esm", target: "es2022", legalComments: "none",
  absWorkingDir: here, logLevel: "warning", charset: "utf8",
};
await esbuild.build({ ...common, entryPoints: ["src/main.ts"], outfile: join(values.out, "app.js") });
await esbuild.build({ ...common, entryPoints: ["src/decode_worker.ts"], outfile: join(values.out, "decode.js") });
await esbuild.build({ ...common, entryPoints: ["src/app.css"], outfile: join(values.out, "app.css") });
for (const file of ["index.html", "icon.svg", "app.webmanifest"])
  copyFileSync(join(here, "src", file), join(values.out, file));

// Whose work is in it.
const licences = Object.keys(JSON.parse(readFileSync(join(here, "package.json"), "utf8")).dependencies)
  .map((name) => {
    const folder = join(here, "node_modules", name);
    const version = JSON.parse(readFileSync(join(folder, "package.json"), "utf8")).version;
    const file = readdirSync(folder).find((entry) => /^licen[cs]e/i.test(entry));
    return `${name} ${version}\n\n${file ? readFileSync(join(folder, file), "utf8").trim() : "MIT"}\n`;
  });
writeFileSync(join(values.out, "licences.txt"), licences.join("\n----------\n\n"));

// What it was built from: tests/lint tells when this is not what is there.
const sources = ["ground/console/live.proto", "ground/measuring/measuring.proto", "package.json", "package-lock.json", "build.mjs",
  ...readdirSync(join(here, "src")).filter((name) => name !== "gen").sort().map((name) => `src/${name}`)];
const lines = sources.map((name) => {
  const path = name.startsWith("ground/") ? join(values.root, name) : join(here, name);
  return `${createHash("sha256").update(readFileSync(path)).digest("hex")}  ${name}`;
});
writeFileSync(join(values.out, "sources.sha256"), lines.join("\n") + "\n");
