// The command line draws the marks that the pages draw: one document, both drawings, every band, curve, interval and point.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {after, before, test} from 'node:test';
import {Daemon, csv} from './world.mjs';

const repository = join(dirname(fileURLToPath(import.meta.url)), '../..');
const require = createRequire(join(repository, 'clients/dashboard/package.json'));
const {build} = require('esbuild');

let daemon;
let folder;

before(async () => {
  daemon = await Daemon.start();
  folder = mkdtempSync(join(tmpdir(), 'driftlab-figures-'));
});
after(async () => {
  await daemon.end();
  rmSync(folder, {recursive: true, force: true});
});

// The pages' own modules; their components have no state and are called as functions.
async function pages() {
  const entry = join(folder, 'entry.ts');
  const at = name => JSON.stringify(join(repository, 'clients/dashboard/src', name));
  writeFileSync(entry, `export {variancePlots} from ${at('pages/recording/plots.ts')};\nexport {layout} from ${at('figure/layout.ts')};\nexport {Drawing} from ${at('figure/Drawing.tsx')};\n`);
  const made = await build({entryPoints: [entry], bundle: true, format: 'esm', write: false, logLevel: 'silent', jsx: 'automatic', jsxImportSource: 'preact', nodePaths: [join(repository, 'clients/dashboard/node_modules')]});
  return import(`data:text/javascript;base64,${Buffer.from(made.outputFiles[0].contents).toString('base64')}`);
}

// Every element below a node with its attributes, in painting order.
function elements(node, found = []) {
  if (Array.isArray(node)) node.forEach(each => elements(each, found));
  else if (node && typeof node === 'object') {
    if (typeof node.type === 'function') elements(node.type(node.props), found);
    else {
      found.push({name: node.type, ...node.props});
      elements(node.props.children, found);
    }
  }
  return found;
}

const numbers = text => [...text.matchAll(/-?\d+(?:\.\d+)?(?:e-?\d+)?/g)].map(match => Number(match[0]));
const point = (x, y) => `${Math.round(Number(x) * 5) / 5},${Math.round(Number(y) * 5) / 5}`;

// A drawing as sorted lists of what carries the data; pixels to a fifth.
function marks(all) {
  const pick = (test, write) => all.filter(test).map(write).sort();
  return {
    circles: pick(e => e.name === 'circle' && Number(e.r) === 3.4, e => point(e.cx, e.cy)),
    intervals: pick(e => e.name === 'line' && Number(e['stroke-width']) === 1.3 && e.x1 !== undefined && Number(e.x1) === Number(e.x2), e => `${point(e.x1, e.y1)} ${point(e.x2, e.y2)}`),
    curves: pick(e => e.name === 'path' && e.fill === 'none' && ['0.8', '1.2', '1.3', '2'].includes(String(e['stroke-width'])), e => `${e['stroke-dasharray'] ?? ''} ${e['stroke-width']} ${numbers(e.d).length}`),
    first: pick(e => e.name === 'path' && e.fill === 'none' && Number(e['stroke-width']) === 2, e => numbers(e.d).slice(0, 40)),
  };
}

function parsed(svg) {
  return [...svg.matchAll(/<(circle|line|path)\b([^>]*?)\/>/g)].map(([, name, rest]) => ({name, ...Object.fromEntries([...rest.matchAll(/([\w-]+)="([^"]*)"/g)].map(([, key, value]) => [key, value]))}));
}

test('the command line draws what the page draws, mark by mark', async () => {
  const recording = await daemon.upload(csv(20000, 5), {device: 'figure', condition: 'static', rate_hz: '100'});
  const job = await daemon.characterise(recording.id);
  const result = await daemon.json(job.result.href);
  const [channel] = result.recordings[0].channels;
  const {items} = await daemon.json(`/v1/fits?recording=${recording.id}&best=true`);
  const {implied} = await daemon.json(`/v1/fits/${items[0].id}/implied`);
  const {variancePlots, layout, Drawing} = await pages();
  const plots = variancePlots(channel, channel.fits[channel.best], implied, 'deg/h', 'allan', {robust: false, components: true, guides: true});
  const page = marks(elements(Drawing({plan: layout(plots, 900), id: 'f', cursor: null})));
  const file = join(folder, 'result.json');
  writeFileSync(file, JSON.stringify(result));
  execFileSync(process.env.DRIFTLAB, ['plot', file, '--output', join(folder, 'out.svg')]);
  const drawn = marks(parsed(readFileSync(join(folder, 'out.svg'), 'utf8')));
  assert.ok(page.circles.length > 20, `points of the page: ${page.circles.length}`);
  const close = (a, b, name) => {
    assert.equal(a.length, b.length, `${name}: ${a.length} on the page, ${b.length} drawn`);
    a.forEach((text, i) => numbers(String(text)).forEach((value, k) => assert.ok(Math.abs(value - numbers(String(b[i]))[k]) <= 0.21, `${name} ${i}: ${text} against ${b[i]}`)));
  };
  for (const name of ['circles', 'intervals', 'curves', 'first']) close(page[name], drawn[name], name);
});

test('a picture and a terminal of 80 columns show the same document', () => {
  const file = join(folder, 'result.json');
  execFileSync(process.env.DRIFTLAB, ['plot', file, '--output', join(folder, 'out.png')]);
  const png = readFileSync(join(folder, 'out.png'));
  assert.equal(png.subarray(1, 4).toString(), 'PNG');
  assert.equal(png.readUInt32BE(16), 1800);
  const text = execFileSync(process.env.DRIFTLAB, ['plot', file], {encoding: 'utf8'});
  const lines = text.split('\n');
  assert.ok(lines.every(line => [...line].length <= 80), 'no line is longer than 80 columns');
  const dots = [...text].filter(c => c > '\u2800' && c <= '\u28ff').length;
  assert.ok(dots > 60, `dots that are set: ${dots}`);
});

test('a report is one file without scripts or outside references, and says the verdict', () => {
  const file = join(folder, 'result.json');
  const page = execFileSync(process.env.DRIFTLAB, ['report', file, '--device', 'figure <1>'], {encoding: 'utf8'});
  assert.match(page, /<h1>figure &lt;1&gt;<\/h1>/);
  assert.match(page, /class="verdict"/);
  assert.match(page, /@page\{size:A4/);
  assert.doesNotMatch(page, /<script|href=|src=|url\((?!#)/);
  assert.equal((page.match(/<svg /g) ?? []).length, 1);
});
