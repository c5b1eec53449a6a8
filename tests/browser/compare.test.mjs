// Side by side: what differs and whether it is shown, conditions and fits, simulation models, data sheets, and names that mean harm.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {after, before, test} from 'node:test';
import {Daemon, accessibilityFaults, characterised, closed, launch, noise, open} from './world.mjs';

let browser;
let daemon;
before(async () => { browser = await launch(); daemon = await Daemon.start(); });
after(async () => { await browser?.close(); await daemon?.end(); });

const RATE = 100;
const recorded = (values, about) => characterised(daemon, values, about);

// The first table of a page's CSV: names of columns and the first row.
async function csvOf(page) {
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', {name: 'CSV'}).first().click()]);
  return readFileSync(await download.path(), 'utf8').split('\n').map(line => line.split(/,(?=(?:[^"]*"[^"]*")*[^"]*$)/));
}

test('what is compared has a difference with its interval, and says whether one is shown', async () => {
  const ids = [];
  for (const [seed, level] of [[81, 0.1], [82, 0.1], [83, 0.15]]) ids.push(await recorded(noise(12000, seed, level), {device: 'pair', id: `pair-${seed}`}));
  const page = await open(browser, daemon, `/compare?with=${ids.join(',')}`);
  const row = page.getByRole('row', {name: /white noise N/});
  await row.waitFor();
  const cells = await row.getByRole('cell').allInnerTexts();
  assert.match(cells[1], /no difference shown: [+\u2212]?\d+(\.\d+)? \[\u2212/, cells.join(' | '));
  assert.match(cells[2], /differs by \+\d+\.\d+ \[\d+\.\d+, \d+\.\d+\], 1\.5\d* \[1\.\d+, 1\.\d+\] times/, cells.join(' | '));
  // The sentence is the daemon's, which tests what the names of the models ranked first would only compare.
  const {statement} = await daemon.json(`/v1/structures?of=${ids.map(id => `${id}:gz%2520%255Bdeg%252Fs%255D`).join(',')}`);
  assert.match(statement, /^(They have one structure|The structures differ|One structure)/);
  assert.equal((await page.locator('.verdict').innerText()).slice(0, 60), statement.slice(0, 60));
  // The ratio is no surer than the two that make it: the distances of their ends on the logarithms, added in squares.
  const [first, second] = (await Promise.all(ids.slice(0, 2).map(id => daemon.json(`/v1/recordings/${id}/characterisation`)))).map(each => each.channels[0].result.allan);
  const wanted = Math.hypot(Math.log(second.ci95[0][1] / second.deviation[0]), Math.log(first.deviation[0] / first.ci95[0][0]));
  const [heading, row0] = await csvOf(page);
  const at = heading.findIndex(name => name.includes('÷ pair-81'));
  const [value, , high] = row0.slice(at, at + 3).map(Number);
  assert.ok(at > 0 && Math.abs(Math.log(high / value) - wanted) < 1e-6, `${heading[at]}: ${value}, ${high}; ${wanted}`);
  await closed(page);
});

test('conditions and fits are compared as recordings are, and nothing has the name of another', async () => {
  const ids = [];
  for (const seed of [84, 85]) ids.push(await recorded(noise(12000, seed, 0.1), {device: 'alike', id: 'static'}));
  ids.push(await recorded(noise(12000, 86, 0.2), {device: 'alike', id: 'turning', condition: 'constant_rate:z:9:deg/s', columns: 'gz [deg/s]=angular_rate:z:deg/s'}));
  const page = await open(browser, daemon, `/compare?with=${ids.slice(0, 2).join(',')}`);
  const chips = page.locator('.chip');
  await chips.filter({hasText: 'static (1)'}).waitFor();
  await chips.filter({hasText: 'static (2)'}).waitFor();
  assert.deepEqual((await page.getByRole('columnheader').allInnerTexts()).slice(1).map(each => each.slice(0, 10)), ['static (1)', 'static (2)']);
  // A fit is the curve that it implies: the second becomes one, and has no points.
  const {fit_ids: fits, result} = (await daemon.json(`/v1/recordings/${ids[1]}/characterisation`)).channels[0];
  await page.getByLabel('Curve of static (2)').selectOption(fits[1]);
  await page.waitForURL(url => url.searchParams.get('with') === `${ids[0]},${fits[1]}`);
  await chips.locator('bdi').filter({hasText: 'static z'}).filter({hasText: result.fits[1].model}).waitFor();
  const implied = (await daemon.json(`/v1/fits/${fits[1]}/implied`)).implied;
  const [heading, row] = await csvOf(page);
  const at = heading.findIndex(name => name.includes(result.fits[1].model) && !name.includes('÷'));
  assert.ok(Math.abs(Number(row[at]) / (3600 * implied.ratio.deviation[0]) - 1) < 1e-9, `${heading[at]}: ${row[at]}, ${implied.ratio.deviation[0]}`);
  await page.goBack();
  await page.waitForURL(url => url.searchParams.get('with') === ids.slice(0, 2).join(','));
  // Found by name: the device's conditions, whose parameters are those of the table.
  await page.getByRole('button', {name: 'Add', exact: true}).click();
  await page.getByLabel('Find what to compare').fill('alike');
  await page.getByRole('button', {name: 'Conditions of alike'}).click();
  await page.getByRole('button', {name: '9 deg/s', exact: true}).click();
  await page.waitForURL(url => (url.searchParams.get('with') ?? '').endsWith(',alike~constant_rate%3Az%3A9%3Adeg%2Fs~gyroscope~z'));
  const table = await daemon.json('/v1/parameter-tables?device=alike&sensor=gyroscope&axis=z');
  const {value} = table.rows.find(each => each.condition.kind === 'constant_rate').values['white_noise.N'];
  const cell = page.getByRole('row', {name: /white noise N/}).getByRole('cell').last();
  await cell.getByText(/differs by/).waitFor();
  assert.ok(Math.abs(Number((await cell.locator('b').innerText()).replace('\u202f', '')) / value - 1) < 0.01);
  await page.getByRole('group', {name: 'Curve'}).getByRole('button', {name: 'Haar'}).click();
  await page.getByRole('heading', {name: 'Haar deviation'}).waitFor();
  await page.getByLabel('normalise').selectOption('1s');
  await page.waitForURL(url => url.searchParams.get('fig') === 'haar' && url.searchParams.get('norm') === '1s');
  await page.reload();
  await page.getByText('Haar deviation ÷ its own at 1 s').first().waitFor();
  await closed(page);
});

const white = value => [{process: 'white_noise', params: {N: {value, unit: 'deg/sqrt(h)'}}}];

test('a simulation model is the curve that it implies, beside its extension, and what is no process is told', async () => {
  const id = await recorded(noise(12000, 87, 0.1), {device: 'flight', id: 'hangar'});
  const base = await daemon.json('/v1/models', {name: 'simulator', device: 'flight', processes: white(0.5)});
  const extended = await daemon.json('/v1/models', {name: 'simulator, mended', device: 'flight', parent: base.id, processes: white(0.6),
    effects: [{cause: 'random_walk', params: {K: {value: 30, unit: 'deg/h/sqrt(h)'}}}, {cause: 'periodic_disturbance', params: {frequency_hz: {value: 12, unit: 'Hz'}, amplitude: {value: 0.02, unit: 'deg/s'}}}]});
  assert.ok(extended.id, JSON.stringify(extended));
  const page = await open(browser, daemon, `/compare?with=${id}`);
  for (const [i, model] of [base, extended].entries()) {
    if (i === 0) await page.getByRole('button', {name: 'Add', exact: true}).click();
    await page.getByLabel('Find what to compare').fill('simulator');
    await page.getByRole('button', {name: model.name, exact: true}).click();
    await page.waitForURL(url => url.searchParams.get('with').split(',')[i + 1] === `${model.id}~${id}~gz%20%5Bdeg%2Fs%5D`);
    await page.locator('.chip', {hasText: `${model.name} z`}).waitFor();
  }
  const row = page.getByRole('row', {name: /white noise N/});
  const cells = await row.getByRole('cell').allInnerTexts();
  // 0.1 deg/s at 100 Hz are N = 0.6 deg/sqrt(h), of which the interval holds the model's number or not; a stated number has none.
  assert.match(cells[1], /^0\.5(00)?\s*differs by \u22120\.\d+ \[\u2212/, cells.join(' | '));
  assert.match(cells[2], /^0\.6(00)?\s*no difference shown/, cells.join(' | '));
  assert.match(await page.getByRole('row', {name: /periodic disturbance frequency/}).innerText(), /–\s+–\s+12/);
  assert.match(await page.getByRole('row', {name: /random walk K/}).innerText(), /–\s+30/);
  await page.getByText(`The curve of ${extended.name} z is without what is no process of the noise: periodic disturbance.`).waitFor();
  const [heading, first] = await csvOf(page);
  for (const model of [base, extended]) {
    const {implied, left_out: leftOut} = await daemon.json(`/v1/models/${model.id}/implied?recording=${id}&channel=${encodeURIComponent('gz [deg/s]')}`);
    assert.deepEqual(leftOut, model === extended ? ['periodic_disturbance'] : []);
    const at = heading.findIndex(name => name.includes(`${model.name} z`) && !name.includes('÷'));
    assert.ok(Math.abs(Number(first[at]) / (3600 * implied.ratio.deviation[0]) - 1) < 1e-9, `${heading[at]}: ${first[at]}, ${implied.ratio.deviation[0]}`);
  }
  // Both alone, as an investigation leads here: a model that somebody wrote has no recording of its own.
  await page.goto(`${daemon.address}/models/${extended.id}`);
  await page.getByRole('link', {name: 'Compare'}).click();
  await page.waitForURL(url => url.searchParams.get('with') === `${base.id},${extended.id}`);
  await page.getByText('simulator is drawn at the times of a recording: add one first, then the model.').waitFor();
  await closed(page);
});

test('an investigation leads to its baseline beside what it found', async () => {
  const ids = [];
  for (const seed of [88, 89]) ids.push(await recorded(noise(12000, seed, 0.1).map((x, i) => x + 0.05 * Math.sin(2 * Math.PI * 17 * i / RATE + seed)), {device: 'shaken', id: `shaken-${seed}`}));
  const study = await daemon.json('/v1/studies', {device: {id: 'shaken'}, recordings: ids.map(recording => ({recording}))});
  const job = await daemon.json('/v1/jobs', {kind: 'investigate', inputs: {study: study.id}});
  assert.equal((await daemon.finished(job.id)).state, 'succeeded');
  const [found] = (await daemon.json(`/v1/investigations?device=shaken`)).items;
  const page = await open(browser, daemon, `/investigations/${found.id}`);
  await page.getByRole('link', {name: 'Compare models'}).click();
  for (const name of ['baseline z', 'extended model z']) await page.locator('.chip', {hasText: name}).waitFor();
  await page.getByRole('row', {name: /periodic disturbance frequency/}).waitFor();
  await page.getByRole('row', {name: /white noise N/}).getByText(/differs by|the same/).waitFor();
  await closed(page);
});

test('what a data sheet states stands beside what was measured, and has no curve', async () => {
  const id = await recorded(noise(12000, 90, 0.1), {device: 'sheeted', id: 'sheeted'});
  const page = await open(browser, daemon, `/compare?with=${id}`);
  await page.getByRole('button', {name: 'Add', exact: true}).click();
  await page.getByLabel('Find what to compare').fill('L3G4200D');
  await page.getByRole('button', {name: 'Data sheet of L3G4200D, gyroscope'}).click();
  await page.waitForURL(url => url.searchParams.get('with') === `${id},sheet~L3G4200D~gyroscope`);
  const cell = page.getByRole('row', {name: /white noise N/}).getByRole('cell').last();
  // 0.03 deg/s/sqrt(Hz), one-sided, are 1.27 deg/sqrt(h): 2.1 times the 0.6 of 0.1 deg/s at 100 Hz.
  await cell.getByText(/differs by \+0\.6\d* \[0\.\d+, 0\.\d+\], 2\.1\d* \[/).waitFor();
  assert.match(await cell.innerText(), /^1\.27\s/);
  const [heading] = await csvOf(page);
  assert.ok(!heading.some(name => name.includes('L3G4200D')), heading.join(' '));
  await page.reload();
  await page.locator('.chip', {hasText: 'L3G4200D, data sheet'}).waitFor();
  await page.goto(`${daemon.address}/compare?with=${id},nonsense`);
  await page.getByText('nonsense is nothing that can be compared.').waitFor();
  await closed(page);
});

test('a device whose name means harm is text in a chip, as wide as the page at most, and turns nothing round', async () => {
  const names = ['<img src=x onerror="window.hurt=1">\'"`&amp;', '\u202egnol dna desrever', `שלום ${'x'.repeat(190)}`];
  for (const [i, device] of names.entries()) await recorded(noise(6000, 91 + i, 0.1), {device, id: `harm-${i}`});
  const conditions = names.map(name => [name, 'static', 'gyroscope', 'z'].map(encodeURIComponent).join('~'));
  const page = await open(browser, daemon, `/compare?with=${encodeURIComponent(conditions.join(','))}`);
  for (const name of names) {
    const chip = page.locator('.chip', {hasText: `${name} static z`});
    await chip.waitFor();
    // The name is shown from its beginning, and its button stands behind it, whichever way it is written.
    await chip.getByRole('button', {name: `Remove ${name}`}).waitFor();
    // Both of one moment: chips move as long as those before them grow.
    const [remove, said] = await chip.evaluate(it => ['button', 'bdi'].map(part => it.querySelector(part).getBoundingClientRect().toJSON()));
    assert.ok(remove.x >= said.x + said.width - 1 || remove.y > said.y, `${JSON.stringify(said)} ${JSON.stringify(remove)}`);
  }
  await page.getByRole('row', {name: /white noise N/}).waitFor();
  for (const width of [390, 768, 1440]) {
    await page.setViewportSize({width, height: 844});
    await page.waitForTimeout(100);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width);
  }
  assert.equal(await page.locator('img').count(), 0);
  assert.equal(await page.evaluate(() => window.hurt), undefined);
  assert.deepEqual(await accessibilityFaults(page), []);
  await page.getByRole('button', {name: `Remove ${names[0]} static z`, exact: true}).click();
  await page.waitForURL(url => url.searchParams.get('with') === conditions.slice(1).join(','));
  await closed(page);
});
