// The pages write numbers by the same cases as the command line: schema/number-format.json.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {dirname, join} from 'node:path';
import {test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {normal} from './world.mjs';

const repository = join(dirname(fileURLToPath(import.meta.url)), '../..');
const require = createRequire(join(repository, 'clients/dashboard/package.json'));
const {build} = require('esbuild');

async function source(name) {
  const made = await build({entryPoints: [join(repository, 'clients/dashboard/src', name)], bundle: true, format: 'esm', write: false, logLevel: 'silent'});
  return import(`data:text/javascript;base64,${Buffer.from(made.outputFiles[0].contents).toString('base64')}`);
}

test('the interval decides the digits', async () => {
  const {writeQuantity} = await source('format/number.ts');
  const {cases} = JSON.parse(readFileSync(join(repository, 'schema/number-format.json'), 'utf8'));
  for (const {value, ci95, text} of cases) assert.equal(writeQuantity({value, unit: '', ci95}).value.replace('\u2212', '-'), text, String(value));
  assert.equal(writeQuantity({value: 1.0382, unit: '', ci95: [1.0347, 1.0417]}).interval, '[1.035, 1.042]');
  assert.equal(writeQuantity({value: null, unit: ''}).value, '…');
});

// Ends of a known normal: a mean of 10 of standard error s has [10 - 1.96 s, 10 + 1.96 s].
test('the interval of a difference and of a ratio holds what it should as often as it should', async () => {
  const {difference, ratio, known} = await source('format/interval.ts');
  const [low, high] = difference({value: 10, low: 9, high: 11}, {value: 4, low: 2, high: 6});
  assert.ok(Math.abs(low - (6 - Math.sqrt(5))) < 1e-12 && Math.abs(high - (6 + Math.sqrt(5))) < 1e-12, `${low}, ${high}`);
  assert.equal(ratio({value: 1, low: -0.1, high: 2}, {value: 1, low: 0.5, high: 2}), null);
  assert.equal(known({value: 1, ci95: [null, 2]}), null);
  const random = normal(5);
  const Z = 1.96;
  let held = 0;
  const RUNS = 4000;
  for (let run = 0; run < RUNS; ++run) {
    // Log-normal estimates of 3 and 2, as uncertain as levels of noise are: 5 and 20 %.
    const [a, b] = [[3, 0.05], [2, 0.2]].map(([truth, s]) => { const value = truth * Math.exp(s * random()); return {value, low: value * Math.exp(-Z * s), high: value * Math.exp(Z * s)}; });
    const ends = ratio(a, b);
    held += ends[0] <= 1.5 && 1.5 <= ends[1] ? 1 : 0;
  }
  // Exact for log-normal estimates: 95 % with a standard error of 0.34 %.
  assert.ok(Math.abs(held / RUNS - 0.95) < 4 * Math.sqrt(0.95 * 0.05 / RUNS), `${held} of ${RUNS}`);
});

test('units and conditions are written as in print', async () => {
  const {writeUnit, conditionName} = await source('format/words.ts');
  assert.equal(writeUnit('deg/h/sqrt(h)'), 'deg/h/√h');
  assert.equal(writeUnit('m/s^2'), 'm/s²');
  assert.equal(conditionName({kind: 'constant_rate', axis: 'z', value: 9, unit: 'deg/s'}, 'z'), '9 deg/s');
  assert.equal(conditionName({kind: 'constant_rate', axis: 'x', value: -9, unit: 'deg/s'}, 'z'), '\u22129 deg/s about x');
});

test('columns are named as schema/names.json has it, numbered from the second of a kind on', async () => {
  const {columnName} = await source('pages/device/documents.ts');
  assert.deepEqual(columnName('gauss_markov_1.beta'), {process: 'Gauss-Markov', symbol: 'β'});
  assert.deepEqual(columnName('gauss_markov_2.sigma'), {process: 'Gauss-Markov 2', symbol: 'σ'});
  assert.deepEqual(columnName('white_noise.N'), {process: 'White noise', symbol: 'N'});
  assert.deepEqual(columnName('low_pass_1.corner_hz'), {process: 'Low-pass noise', symbol: 'corner'});
});

test('counts agree with their nouns, and moments of other days have a date', async () => {
  const {plural} = await source('format/words.ts');
  assert.deepEqual([plural(1, 'gap'), plural(2, 'gap'), plural(0, 'axis', 'axes'), plural(12345, 'sample')], ['1 gap', '2 gaps', '0 axes', '12\u202f345 samples']);
  const {writeMoment} = await source('format/time.ts');
  const now = new Date('2026-11-23T12:00:00Z');
  assert.equal(writeMoment('2026-11-23T07:24:51Z', now), '07:24:51');
  assert.equal(writeMoment('2026-11-22T07:24:51Z', now), '22 Nov 2026 07:24:51');
});

test('equal decades are equal, and a slope of -1/2 looks like one', async () => {
  const {layout} = await source('figure/layout.ts');
  const x = [0.01, 0.1, 1, 10, 100];
  const plan = layout([{id: 'a', equalDecades: true, x: {scale: 'log', name: 'τ, s'}, y: {scale: 'log', name: 'σ'}, series: [{id: 's', name: 's', x, y: x.map(tau => 5 / Math.sqrt(tau)), mark: 'dot', colour: ''}]}], 900);
  const [area] = plan.areas;
  const slope = -(area.y(5 / Math.sqrt(10)) - area.y(5)) / (area.x(10) - area.x(1));
  assert.ok(Math.abs(slope + 0.5) < 1e-6, String(slope));
});

test('an axis has round numbers and leads a value to its pixel and back', async () => {
  const {decadeTicks, linear, logarithmic, ticksBetween} = await source('figure/scale.ts');
  assert.deepEqual(ticksBetween(0, 10, 5), [0, 2, 4, 6, 8, 10]);
  assert.deepEqual(ticksBetween(-0.31, 0.27, 4), [-0.2, 0, 0.2]);
  assert.deepEqual(ticksBetween(0, 3725, 9), [0, 500, 1000, 1500, 2000, 2500, 3000, 3500]);
  assert.deepEqual(ticksBetween(2, 2, 3), [2]);
  assert.deepEqual(decadeTicks(0.2, 30, [1, 2, 5]), [0.2, 0.5, 1, 2, 5, 10, 20]);
  const x = linear(2, 6, 100, 300);
  assert.deepEqual([x(2), x(3), x(6), x.invert(150)], [100, 150, 300, 3]);
  const y = logarithmic(0.1, 1000, 400, 0);
  assert.ok([[0.1, 400], [1, 300], [1000, 0]].every(([value, pixel]) => Math.abs(y(value) - pixel) < 1e-9 && Math.abs(y.invert(pixel) / value - 1) < 1e-12));
  assert.deepEqual([linear(5, 5, 0, 80)(5), linear(5, 5, 0, 80).invert(10)], [40, 5]);
});
