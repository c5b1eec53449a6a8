// Bundles src/ into files with their hash in their name, and writes them as a C++ source of the daemon.
//
//   node build.mjs [--out DIR] [--embed FILE.cpp]
//
// The document itself holds no script and no style, so that the daemon may forbid both (server/pages/pages.cpp).
import {createHash} from 'node:crypto';
import {mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync} from 'node:fs';
import {basename, dirname, extname, join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';
import {gzipSync} from 'node:zlib';
import {build} from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const option = (name, otherwise) => {
  const at = process.argv.indexOf(name);
  return at < 0 ? otherwise : resolve(process.argv[at + 1]);
};
const out = option('--out', join(here, 'dist'));
const embed = option('--embed', undefined);

const BUDGET_KIB = 120;       // scripts and styles, gzip as the daemon packs them; the two fonts stand beside it
const FIRST_PAGE_KIB = 45;    // of these the shell and the Lab
const TYPES = {'.html': 'text/html; charset=utf-8', '.js': 'text/javascript; charset=utf-8', '.css': 'text/css; charset=utf-8',
               '.woff2': 'font/woff2', '.svg': 'image/svg+xml', '.txt': 'text/plain; charset=utf-8'};

rmSync(out, {recursive: true, force: true});
const {metafile} = await build({
  absWorkingDir: here, metafile: true,
  entryPoints: [join(here, 'src/main.tsx'), join(here, 'src/style/main.css')],
  outdir: join(out, 'assets'), outbase: join(here, 'src'), entryNames: '[name]-[hash]', chunkNames: '[name]-[hash]',
  assetNames: '[name]-[hash]', bundle: true, splitting: true, format: 'esm', minify: true, target: 'es2021',
  jsx: 'automatic', jsxImportSource: 'preact', loader: {'.woff2': 'file', '.svg': 'file'}, legalComments: 'none',
  logLevel: 'warning', define: {DRIFTLAB_VERSION: JSON.stringify(JSON.parse(readFileSync(join(here, 'package.json'), 'utf8')).version)},
});

const assets = readdirSync(join(out, 'assets')).sort();
const outputs = Object.entries(metafile.outputs).map(([path, output]) => ({file: basename(path), ...output}));
const holding = source => outputs.find(output => extname(output.file) === '.js' && source in output.inputs);
const shell = holding('src/app.tsx');
const style = outputs.find(output => output.entryPoint === 'src/style/main.css');
// The entry only asks for the shell, which the document asks for itself: one step less before anything is painted.
const step = outputs.find(output => output.entryPoint === 'src/main.tsx');
if (!shell || shell === step || shell.imports.some(each => each.kind === 'import-statement')) {
  console.error('The shell is no longer one file: what it shares with pages belongs into src/routes/shell.ts.');
  process.exit(1);
}
rmSync(join(out, 'assets', step.file));
assets.splice(assets.indexOf(step.file), 1);
const icon = readFileSync(join(here, 'src/style/mark.svg'));
const iconName = `mark-${createHash('sha256').update(icon).digest('hex').slice(0, 8)}.svg`;
writeFileSync(join(out, 'assets', iconName), icon);
// The licence of the fonts goes with them.
writeFileSync(join(out, 'assets', 'Inter-OFL.txt'), readFileSync(join(here, 'src/fonts/Inter-OFL.txt')));
writeFileSync(join(out, 'index.html'), `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>driftlab</title>
<link rel="icon" href="/assets/${iconName}" type="image/svg+xml">
<link rel="stylesheet" href="/assets/${style.file}">
<script type="module" src="/assets/${shell.file}"></script>
</head>
<body>
<div id="page"><noscript>The dashboard needs JavaScript. The API answers without: <a href="/v1/devices">/v1/devices</a>, <a href="/openapi.json">/openapi.json</a>.</noscript></div>
</body>
</html>
`);

const packedKib = names => names.reduce((sum, name) => sum + gzipSync(readFileSync(join(out, name)), {level: 9}).length, 0) / 1024;
const refuse = (what, kib, budget) => {
  if (kib <= budget) return;
  console.error(`${what} ${kib.toFixed(1)} KiB in gzip; the budget is ${budget} KiB.`);
  process.exit(1);
};
const files = ['index.html', ...readdirSync(join(out, 'assets')).sort().map(name => `assets/${name}`)];
const kib = packedKib(files.filter(name => /\.(js|css)$/.test(name)));
refuse('The dashboard\'s scripts and styles are', kib, BUDGET_KIB);
const lab = holding('src/pages/Lab.tsx');
const first = [style, shell, lab, ...lab.imports.filter(each => each.kind === 'import-statement').map(each => outputs.find(output => output.file === basename(each.path)))];
const firstKib = packedKib([...new Set(first.map(each => `assets/${each.file}`))]);
refuse('Shell and Lab are', firstKib, FIRST_PAGE_KIB);
console.log(`dashboard: ${files.length} files, scripts and styles ${kib.toFixed(1)} of ${BUDGET_KIB} KiB (gzip), ${firstKib.toFixed(1)} of ${FIRST_PAGE_KIB} for shell and Lab`);

if (embed) {
  const literal = bytes => {
    const lines = [];
    for (let start = 0; start < bytes.length; start += 4000) {
      let line = '';
      for (const byte of bytes.subarray(start, start + 4000)) {
        const plain = byte >= 32 && byte < 127 && byte !== 34 && byte !== 92 && byte !== 63;
        line += plain ? String.fromCharCode(byte) : `\\${byte.toString(8).padStart(3, '0')}`;
      }
      lines.push(`"${line}"`);
    }
    return lines.length > 0 ? lines.join('\n    ') : '""';
  };
  const entries = files.map(name => {
    const bytes = readFileSync(join(out, name));
    return `    {"/${name}", "${TYPES[extname(basename(name))]}",\n    {${literal(bytes)}, ${bytes.length}}},`;
  });
  mkdirSync(dirname(embed), {recursive: true});
  writeFileSync(embed, `#include "server/pages/dashboard_files.hpp"

#pragma GCC diagnostic ignored "-Woverlength-strings"

namespace driftlab::server {

const std::vector<DashboardFile>& dashboard_files() {
  static const std::vector<DashboardFile> files{
${entries.join('\n')}
  };
  return files;
}

}  // namespace driftlab::server
`);
}
