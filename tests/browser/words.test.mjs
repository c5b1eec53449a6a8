// The pages write numbers by the same cases as the command line: schema/number-format.json.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {dirname, join} from 'node:path';
import {test} from 'node:test';
import {fileURLToPath} from 'node:url';

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

test('units and conditions are written as in print', async () => {
  const {writeUnit, conditionName} = await source('format/words.ts');
  assert.equal(writeUnit('deg/h/sqrt(h)'), 'deg/h/√h');
  assert.equal(writeUnit('m/s^2'), 'm/s²');
  assert.equal(conditionName({kind: 'constant_rate', axis: 'z', value: 9, unit: 'deg/s'}, 'z'), '9 deg/s');
  assert.equal(conditionName({kind: 'constant_rate', axis: 'x', value: -9, unit: 'deg/s'}, 'z'), '\u22129 deg/s about x');
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
