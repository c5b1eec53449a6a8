// The colours of style/tokens.css against the brief: their contrast on the surface, and whether the six data colours stay apart for eyes
// that lack a kind of cone.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {dirname, join} from 'node:path';
import {test} from 'node:test';
import {fileURLToPath} from 'node:url';

const repository = join(dirname(fileURLToPath(import.meta.url)), '../..');
const text = readFileSync(join(repository, 'clients/dashboard/src/style/tokens.css'), 'utf8');

const tokensOf = block => Object.fromEntries([...block.matchAll(/--([\w-]+):(#[0-9a-f]{6})\b/g)].map(([, name, value]) => [name, value]));
const block = selector => { const from = text.indexOf(`${selector}{`); assert.ok(from >= 0, selector); return text.slice(from, text.indexOf('}', from)); };
const themes = {light: tokensOf(block(':root,.light')), dark: tokensOf(block(':root.dark'))};

const linear = colour => [1, 3, 5].map(at => { const c = parseInt(colour.slice(at, at + 2), 16) / 255; return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; });
// WCAG 2.2, relative luminance and contrast ratio.
const luminance = colour => { const [r, g, b] = linear(colour); return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
const contrast = (a, b) => { const [high, low] = [luminance(a), luminance(b)].sort((x, y) => y - x); return (high + 0.05) / (low + 0.05); };

// What the brief states, light and dark, rounded to a tenth.
const STATED = {ink: [17.6, 14.8], ink2: [8.2, 9.1], ink3: [5.3, 6.0], rule: [3.6, 4.2], focus: [5.8, 8.2], model: [6.0, 7.9], robust: [5.0, 8.5], 'c-wn': [5.5, 8.8], 'c-gm': [9.1, 11.8], 'c-rw': [9.3, 15.5]};
const AT_LEAST = {r1: [3.6, 4.9], r2: [3.6, 4.9], r3: [3.6, 4.9], r4: [3.6, 4.9], a1: [3.6, 4.9], a2: [3.6, 4.9], bad: [6.1, 7.3], warn: [6.1, 7.3], good: [6.1, 7.3]};

test('every colour has the contrast on the surface that the brief states', () => {
  for (const [i, [theme, tokens]] of Object.entries(themes).entries()) {
    for (const [name, stated] of Object.entries(STATED)) assert.ok(Math.abs(contrast(tokens[name], tokens.surface) - stated[i]) < 0.06, `${theme} ${name}: ${contrast(tokens[name], tokens.surface).toFixed(2)}, stated ${stated[i]}`);
    for (const [name, least] of Object.entries(AT_LEAST)) assert.ok(contrast(tokens[name], tokens.surface) > least[i] - 0.05, `${theme} ${name}: ${contrast(tokens[name], tokens.surface).toFixed(2)}, at least ${least[i]}`);
  }
});

test('words on the sunken ground and on the page can be read, whichever of the two inks they have', () => {
  for (const [theme, tokens] of Object.entries(themes)) {
    for (const ground of ['sunken', 'page', 'surface']) for (const ink of ['ink', 'ink2']) assert.ok(contrast(tokens[ink], tokens[ground]) >= 4.5, `${theme}: ${ink} on ${ground}`);
  }
});

test('the system and the chosen dark theme are the same colours', () => {
  assert.deepEqual(tokensOf(block('@media (prefers-color-scheme:dark){:root:not(.light)')), themes.dark);
});

// Machado, Oliveira and Fernandes (2009), severity 1, on linear RGB.
const LACKING = {
  deuteranopia: [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
  protanopia: [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
};
// CIE 1976 L*a*b* of linear sRGB, white D65, and the distance in it.
const XYZ = [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]];
const WHITE = [0.95047, 1, 1.08883];
const times = (matrix, vector) => matrix.map(row => row.reduce((sum, weight, i) => sum + weight * vector[i], 0));
const labOf = colour => {
  const [x, y, z] = times(XYZ, colour).map((value, i) => { const t = value / WHITE[i]; return t > (6 / 29) ** 3 ? Math.cbrt(t) : t / 3 / (6 / 29) ** 2 + 4 / 29; });
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
};
const seen = (matrix, colour) => labOf(times(matrix, linear(colour)).map(c => Math.min(Math.max(c, 0), 1)));
const distance = (a, b) => Math.hypot(...a.map((value, i) => value - b[i]));

test('the six data colours stay apart for eyes without red or green cones', () => {
  const names = ['measured', 'model', 'robust', 'c-wn', 'c-gm', 'c-rw'];
  for (const [theme, least] of [['light', 12], ['dark', 19]]) {
    for (const [kind, matrix] of Object.entries(LACKING)) {
      const colours = names.map(name => seen(matrix, themes[theme][name]));
      const pairs = names.flatMap((a, i) => names.slice(i + 1).map((b, j) => ({pair: `${a} and ${b}`, apart: distance(colours[i], colours[i + 1 + j])})));
      const nearest = pairs.reduce((best, pair) => pair.apart < best.apart ? pair : best);
      assert.ok(nearest.apart >= least - 0.5, `${theme}, ${kind}: ${nearest.pair} are ${nearest.apart.toFixed(1)} apart`);
    }
  }
});
