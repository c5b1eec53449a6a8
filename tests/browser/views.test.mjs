// What a page shows is in its address, what was typed outlives a reload, and what is said of samples leads to them.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {after, before, test} from 'node:test';
import {Daemon, csv, launch, noise, open} from './world.mjs';

let browser;
let daemon;
before(async () => { browser = await launch(); daemon = await Daemon.start(); });
after(async () => { await browser?.close(); await daemon?.end(); });

const closed = async page => { assert.deepEqual(page.loud, []); await page.context().close(); };
const panel = (page, title) => page.locator('section.panel', {has: page.getByRole('heading', {name: title, exact: true})});
const RATE = 100;

// A recording with a gap, three numbers that are no measurement, a frozen stretch and full scale; the first two seconds are trimmed.
function troubled() {
  const values = noise(6000, 31, 0.5).map(value => Math.max(-1.5, Math.min(1.5, value)));
  for (let i = 3000; i < 3020; ++i) values[i] = 1.5;
  for (let i = 4000; i < 4600; ++i) values[i] = 0.125;
  const rows = values.map((value, i) => `${(i / RATE + (i >= 1500 ? 0.3 : 0)).toFixed(3)},${value.toFixed(5)}`);
  for (const i of [2000, 2001, 2002]) rows[i] = rows[i].replace(/,.*/, ',-9999');
  return `t,gz [deg/s]\n${rows.join('\n')}\n`;
}

test('the signal marks what is no noise of the sensor, and each sentence leads to its samples', async () => {
  const made = await daemon.upload(troubled(), {device: 'bench', condition: 'static', id: 'troubled', columns: 't=time::s,gz [deg/s]=angular_rate:z:deg/s', trim_start_s: 2});
  const page = await open(browser, daemon, `/recordings/${made.id}`);
  const signal = panel(page, 'Signal');
  const svg = signal.locator('svg[tabindex]');
  await svg.waitFor();
  const described = await svg.getAttribute('aria-label');
  for (const kind of ['trim', 'gap', 'flagged', 'frozen', 'saturated']) assert.match(described, new RegExp(`marked:.*${kind}`), kind);
  // What is no measurement does not flatten the rest.
  const ticks = await svg.locator('text[text-anchor=end]').allTextContents();
  assert.ok(ticks.every(text => Math.abs(Number(text.replace('\u2212', '-'))) < 10), ticks.join(' '));
  await signal.locator('.quality-note', {hasText: '1 stretch with no measurement in it'}).getByRole('button').click();
  await page.waitForURL(/t0=19/);
  const query = new URL(page.url()).searchParams;
  assert.ok(Number(query.get('t0')) < 20 && Number(query.get('t1')) > 20.03, page.url());
  await signal.getByText(/\d+ samples,/).waitFor();  // down to the samples themselves
  await page.goBack();
  await signal.locator('.quality-note', {hasText: '1 gap, 30 samples missing in it'}).getByRole('button').click();
  await page.waitForURL(/t0=14/);
  await signal.getByRole('button', {name: 'Show all'}).click();
  await signal.locator('.quality-note', {hasText: 'frozen for 6.0 s'}).waitFor();
  await signal.locator('.quality-note', {hasText: /at full scale/}).first().waitFor();
  const [download] = await Promise.all([page.waitForEvent('download'), signal.getByRole('button', {name: 'SVG', exact: true}).click()]);
  assert.match(readFileSync(await download.path(), 'utf8'), />driftlab \d+\.\d+\.\d+, rec_\w+ gz \[deg\/s\], revision 1</);
  await closed(page);
});

test('brackets go to the recordings before and after, which the device has in the order of upload', async () => {
  const ids = [];
  for (let i = 0; i < 3; ++i) ids.push((await daemon.upload(csv(600, 40 + i), {device: 'row', condition: 'static', rate_hz: RATE, id: `row-${i}`})).id);
  const page = await open(browser, daemon, `/recordings/${ids[1]}`);
  await page.getByRole('heading', {level: 1, name: 'row-1'}).waitFor();
  await page.keyboard.press(']');
  await page.getByRole('heading', {level: 1, name: 'row-2'}).waitFor();
  await page.keyboard.press(']');
  await page.getByText('This is the last recording of the device.').waitFor();
  await page.keyboard.press('[');
  await page.getByRole('heading', {level: 1, name: 'row-1'}).waitFor();
  await page.keyboard.press('[');
  await page.getByRole('heading', {level: 1, name: 'row-0'}).waitFor();
  await page.keyboard.press('[');
  await page.getByText('This is the first recording of the device.').waitFor();
  await closed(page);
});

test('in a figure the arrows choose point and curve, and what they reach is spoken', async () => {
  const {id} = await daemon.upload(csv(8000, 51), {device: 'curves', condition: 'static', rate_hz: RATE, id: 'curves'});
  await daemon.characterise(id);
  const page = await open(browser, daemon, `/recordings/${id}?show=robust,components,guides`);
  const figure = panel(page, 'Allan deviation');
  const svg = figure.locator('svg[tabindex]');
  await svg.waitFor();
  assert.equal(await svg.getAttribute('role'), 'img');
  for (const slope of ['−1', '−½', '0', '+½', '+1']) assert.ok((await svg.locator('text.s.h').allTextContents()).includes(slope), slope);
  await svg.focus();
  assert.equal(await svg.getAttribute('role'), 'application');
  await page.keyboard.press('Home');
  await page.waitForURL(/tau=0\.01/);
  await page.keyboard.press('ArrowDown');
  await figure.locator('.readout', {hasText: '↑↓ classical'}).waitFor();
  await figure.locator('[aria-live]', {hasText: /averaging time τ, s 0\.01\S*, classical \S+, \S+ to \S+$/}).waitFor({state: 'attached'});
  await page.keyboard.press('ArrowUp');
  const last = await figure.locator('.readout').innerText();
  assert.match(last, /↑↓ (?!classical)/);
  await page.keyboard.press('Tab');
  assert.equal(await svg.getAttribute('role'), 'img');
  await closed(page);
});

test('what was typed of a file is there after a reload, in this tab alone', async () => {
  const page = await open(browser, daemon, '/upload');
  await page.locator('input[type=file]').setInputFiles({name: 'typed.csv', mimeType: 'text/csv', buffer: Buffer.from(csv(900, 61))});
  await page.getByLabel('Device of typed.csv', {exact: true}).fill('typed-device');
  await page.getByLabel('Rate in Hz of typed.csv').fill('125');
  await page.getByLabel('Condition of typed.csv', {exact: true}).selectOption('constant_rate');
  await page.getByLabel('Condition of typed.csv: deg/s').fill('36');
  await page.getByText('1 column read').waitFor();
  await page.reload();
  assert.equal(await page.getByLabel('Device of typed.csv', {exact: true}).inputValue(), 'typed-device');
  assert.equal(await page.getByLabel('Rate in Hz of typed.csv').inputValue(), '125');
  assert.equal(await page.getByLabel('Condition of typed.csv: deg/s').inputValue(), '36');
  await page.getByText('1 column read').waitFor();  // the file itself is there
  const other = await page.context().newPage();
  await other.goto(`${daemon.address}/upload`);
  await other.getByText('Drop recordings').waitFor();
  await other.waitForTimeout(500);
  assert.equal(await other.locator('table.files').count(), 0);
  await page.getByRole('button', {name: 'Upload only'}).click();
  await page.getByRole('link', {name: 'stored'}).waitFor();
  const {items: [stored]} = await daemon.json('/v1/recordings?device=typed-device');
  assert.deepEqual([stored.metadata.rate_hz, stored.metadata.condition.value, stored.metadata.id], [125, 36, 'typed']);
  await page.reload();
  await page.getByText('Drop recordings').waitFor();
  await page.waitForTimeout(500);
  assert.equal(await page.locator('table.files').count(), 0, 'what is stored does not wait any more');
  await closed(page);
});

test('a unit that is not known is mended beside the sentence that refuses it', async () => {
  const page = await open(browser, daemon, '/upload');
  await page.locator('input[type=file]').setInputFiles({name: 'odd.csv', mimeType: 'text/csv', buffer: Buffer.from(csv(900, 62, 'gz [furlong/s]'))});
  await page.getByText("The unit 'furlong/s' is not known").first().waitFor();
  await page.getByLabel('Rate in Hz of odd.csv').fill('100');
  await page.getByLabel('Unit that repairs odd.csv').selectOption('angular_rate|deg/s');
  await page.getByText('1 column read').waitFor();
  assert.deepEqual([await page.getByLabel('Quantity of gz [furlong/s]').inputValue(), await page.getByLabel('Axis of gz [furlong/s]').inputValue(), await page.getByLabel('Unit of gz [furlong/s]').inputValue()], ['angular_rate', 'z', 'deg/s']);
  await closed(page);
});

test('counts have their scale and their offset beside the unit', async () => {
  const page = await open(browser, daemon, '/upload', {absent: [/recordings\/preview/]});
  const rows = noise(400, 63).map((x, i) => `${i * 10},${(1179 + 13 * x).toFixed(0)},${-3000 + i % 9}`).join('\n');
  await page.locator('input[type=file]').setInputFiles({name: 'counts.csv', mimeType: 'text/csv', buffer: Buffer.from(`time (ms),gz,temp\n${rows}\n`)});
  await page.getByRole('row', {name: /^temp .*read from the header/}).waitFor();
  for (const [column, quantity, scale] of [['gz', 'angular_rate', '/131'], ['temp', 'temperature', '/340+36.53']]) {
    await page.getByLabel(`Quantity of ${column}`).selectOption({value: quantity});  // the first option has the same word, as read
    await page.getByLabel(`Scale and offset of ${column}`).fill(scale);
    await page.getByLabel(`Scale and offset of ${column}`).blur();
  }
  await page.getByText('The gyroscope about z reads 9').first().waitFor();
  assert.equal(await page.getByLabel('Unit of temp').inputValue(), 'degC');
  await page.getByLabel('Scale and offset of gz').fill('/0');
  await page.getByLabel('Scale and offset of gz').blur();
  await page.getByText("The scale in the unit 'deg/s/0' must be a positive number").first().waitFor();
  await page.getByLabel('Scale and offset of gz').fill('/131');
  await page.getByLabel('Scale and offset of gz').blur();
  await page.getByText('The gyroscope about z reads 9').first().waitFor();
  await page.getByRole('button', {name: 'Upload only'}).click();
  await page.getByRole('link', {name: 'stored'}).waitFor();
  const stored = (await daemon.json('/v1/recordings?sort=-created_at')).items[0];
  assert.deepEqual([stored.metadata.columns.gz.unit, stored.metadata.columns.temp.unit], ['deg/s/131', 'degC/340+36.53']);
  await closed(page);
});

test('a study.json says what its files are, and leads to their investigation', async () => {
  const file = (name, text) => ({name, mimeType: 'text/plain', buffer: Buffer.from(text)});
  const columns = {gz: {quantity: 'angular_rate', axis: 'z', unit: 'deg/s'}};
  const study = {device: {id: 'studied'}, baseline: {kind: 'auto'}, recordings: [
    {id: 'rest', file: 'a.csv', rate_hz: 100, columns, condition: {kind: 'static'}, trim: {start_s: 1}},
    {id: 'turning', file: 'sub/b.csv', rate_hz: 100, columns, condition: {kind: 'constant_rate', axis: 'z', value: 9, unit: 'deg/s'}}]};
  const page = await open(browser, daemon, '/upload');
  await page.locator('input[type=file]').setInputFiles([file('study.json', JSON.stringify(study)), file('a.csv', csv(4000, 71, 'gz'))]);
  await page.getByText('The study names sub/b.csv, which was not dropped with it.').waitFor();
  const turning = `gz\n${noise(4000, 72).map(x => (9 + x).toFixed(6)).join('\n')}\n`;
  await page.locator('input[type=file]').setInputFiles([file('study.json', JSON.stringify(study)), file('a.csv', csv(4000, 71, 'gz')), file('b.csv', turning)]);
  await page.getByLabel('Condition of b.csv: deg/s').waitFor();
  assert.equal(await page.getByLabel('Device of a.csv', {exact: true}).inputValue(), 'studied');
  await page.getByRole('button', {name: 'Upload two and investigate'}).click();
  await page.waitForURL(/\/jobs\/job_/);
  const job = await daemon.finished(page.url().split('/').pop());
  assert.deepEqual([job.kind, job.state], ['investigate', 'succeeded']);
  const {items} = await daemon.json('/v1/recordings?device=studied&sort=created_at');
  assert.deepEqual(items.map(one => [one.metadata.id, one.metadata.condition.kind]), [['rest', 'static'], ['turning', 'constant_rate']]);
  assert.deepEqual(items[0].metadata.trim?.start_s, 1);
  await closed(page);
});

test('typing into a list is one step, which Back undoes', async () => {
  for (let i = 0; i < 60; ++i) await daemon.json('/v1/devices', {name: `shelf-${String(i).padStart(2, '0')}`, model: i === 7 ? 'Rare-7' : 'Common'});
  const page = await open(browser, daemon, '/jobs');
  await page.getByRole('link', {name: 'Devices', exact: true}).first().click();
  const rows = page.locator('main table tbody tr');
  await rows.first().waitFor();
  await page.getByLabel('Only names and models with').pressSequentially('rare-7', {delay: 90});
  await page.getByRole('rowheader', {name: 'shelf-07'}).waitFor();  // older than the newest fifty
  while (await rows.count() !== 1) await page.waitForTimeout(30);
  assert.match(page.url(), /q=rare-7/);
  await page.reload();
  assert.equal(await page.getByLabel('Only names and models with').inputValue(), 'rare-7');
  await page.goBack();
  await page.waitForURL(url => url.pathname === '/devices' && url.search === '');
  // The address changes before the page is drawn again.
  while (await page.getByLabel('Only names and models with').inputValue() !== '') await page.waitForTimeout(30);
  await page.goBack();
  await page.waitForURL(/\/jobs$/);
  await closed(page);
});

test('what is found: recordings, conditions and beginnings of ids, on a narrow screen too', async () => {
  const {id} = await daemon.upload(csv(600, 81), {device: 'finder', condition: 'constant_rate:z:24:deg/s', rate_hz: RATE, id: 'spin table'});
  const page = await open(browser, daemon, '/', {viewport: {width: 390, height: 844}});
  assert.equal(await page.locator('#find').isVisible(), false);
  await page.getByRole('button', {name: 'Menu'}).click();
  await page.locator('#find').fill('24 deg/s');
  await page.getByRole('option', {name: /spin table.*recording of finder, 24 deg\/s about z/}).click();
  await page.waitForURL(new RegExp(id));
  await page.locator('#find').waitFor({state: 'hidden'});
  await page.setViewportSize({width: 1440, height: 900});
  await page.keyboard.press('/');
  await page.keyboard.type(id.slice(0, 22).toLowerCase());
  await page.getByRole('option', {name: /spin table/}).waitFor();
  await closed(page);
});

test('the page of jobs says how many run at a time', async () => {
  const {workers} = await daemon.json('/v1/workers');
  assert.ok(workers > 0);
  const page = await open(browser, daemon, '/jobs');
  await page.locator('.meta', {hasText: `${workers} worker${workers === 1 ? '' : 's'}`}).waitFor();
  await closed(page);
});

test('a job that has ended says what became of it, step by step', async () => {
  const made = await daemon.upload(csv(6000, 61), {device: 'stepwise', condition: 'static', rate_hz: RATE});
  const job = await daemon.characterise(made.id);
  const page = await open(browser, daemon, `/jobs/${job.id}`);
  const steps = panel(page, 'Events').locator('tbody tr');
  await steps.first().waitFor();
  const states = await steps.locator('td:nth-child(2)').allInnerTexts();
  assert.deepEqual([states[0], states.at(-1)], ['queued', 'succeeded']);
  assert.equal(await steps.locator('td:last-child').last().innerText(), '1');
  await closed(page);
});

test('addresses hold kind, label, parameter and finding', async () => {
  const page = await open(browser, daemon, '/jobs?kind=investigate');
  await page.getByRole('heading', {level: 1, name: 'Jobs'}).waitFor();
  assert.equal(await page.getByLabel('kind').inputValue(), 'investigate');
  while (await page.locator('main table tbody tr:not(.axis)').count() !== 1) await page.waitForTimeout(30);
  await page.getByLabel('kind').selectOption('characterise');
  await page.waitForURL(/kind=characterise/);
  await page.goto(`${daemon.address}/outages/new`);
  await page.getByRole('heading', {level: 1, name: 'Simulate outages'}).waitFor();
  await page.getByRole('button', {name: 'Simulate'}).waitFor();
  await page.goto(`${daemon.address}/regressions?label=firmware%3D0.0`);
  await page.getByText('No run has the candidate “firmware=0.0”.').waitFor();
  await page.goto(`${daemon.address}/devices/curves`);
  await page.setViewportSize({width: 390, height: 844});
  const parameters = page.getByRole('group', {name: 'Parameter', exact: true});
  await parameters.getByRole('button').last().click();
  await page.waitForURL(/param=/);
  await page.reload();
  assert.equal(await parameters.getByRole('button').last().getAttribute('aria-pressed'), 'true');
  await closed(page);
});

// Two lines in noise, and what the page of their investigation makes of them.
test('an investigation’s figure ranks the sinusoids it identified first and marks them; what is left is named', {timeout: 240000}, async () => {
  const rate = 50;
  const lines = [[7.3, 0.05], [13.7, 0.04]];
  const random = noise(60000, 91, 0.1);
  const text = `gz\n${random.map((x, i) => (x + lines.reduce((sum, [f, a]) => sum + a * Math.sin(2 * Math.PI * f * i / rate), 0)).toFixed(6)).join('\n')}\n`;
  const {id} = await daemon.upload(text, {device: 'hum', condition: 'static', rate_hz: rate, id: 'hum', columns: 'gz=angular_rate:z:deg/s'});
  const study = await daemon.json('/v1/studies', {device: {id: 'hum'}, recordings: [{recording: id}], baseline: {kind: 'model', processes: [{process: 'white_noise', params: {N: {value: 0.1 / Math.sqrt(rate) * 60, unit: 'deg/sqrt(h)'}}}]}});
  const job = await daemon.json('/v1/jobs', {kind: 'investigate', inputs: {study: study.id}});
  assert.equal((await daemon.finished(job.id)).state, 'succeeded');
  const {items: [row]} = await daemon.json(`/v1/investigations?job=${job.id}`);
  const found = await daemon.json(`/v1/investigations/${row.id}`);
  const frequencies = found.findings.filter(finding => finding.status === 'identified').map(finding => Object.values(finding.parameters).find(one => one.unit === 'Hz')?.value).filter(Boolean).sort((a, b) => a - b);
  assert.equal(frequencies.length, lines.length, JSON.stringify(found.findings.map(finding => [finding.cause, finding.status])));
  frequencies.forEach((f, i) => assert.ok(Math.abs(f - lines[i][0]) < 0.01, `${f}`));
  // The bins in which they lie are the highest of the figure (the figure once ranked them 4th to 61st).
  const {spectrum} = found.figures[0];
  const step = spectrum.f_hz[1] - spectrum.f_hz[0];
  const heights = spectrum.highest.map((value, i) => value / spectrum.baseline.median[i]);
  const ranked = heights.map((_, i) => i).sort((a, b) => heights[b] - heights[a]);
  const ofLines = frequencies.map(f => ranked.findIndex(i => Math.abs(spectrum.f_hz[i] - f) <= step / 2 + 1e-9));
  assert.deepEqual([...ofLines].sort(), [0, 1], `their ranks in the figure: ${ofLines}`);
  for (const rank of ofLines) assert.ok(spectrum.highest[ranked[rank]] > spectrum.chance[ranked[rank]], 'above what chance reaches');

  const page = await open(browser, daemon, `/investigations/${row.id}`);
  const figure = panel(page, 'Spectrum');
  await figure.locator('svg[tabindex]').waitFor();
  const words = await figure.locator('svg text.s.h').allTextContents();
  for (const f of ['7.3 Hz', '13.7 Hz']) assert.ok(words.includes(f), words.join(', '));
  await figure.getByText(/nothing is left above chance|left over, in no finding/).waitFor();
  await panel(page, 'Innovations by scale').locator('svg circle').first().waitFor();
  const count = found.figures[0].innovations.length;
  assert.equal(await panel(page, 'Innovations by scale').locator('svg circle').count(), 2 * count, 'before and after, every scale that the checks judge');
  const findings = panel(page, 'Periodic disturbance');
  assert.deepEqual((await findings.getByRole('columnheader').allInnerTexts()).slice(0, 3), ['axis', 'amplitude', 'frequency'], 'rows under their columns');
  assert.equal(await findings.locator('tbody.finding').count(), lines.length);
  await findings.locator('summary').first().click();
  await page.waitForURL(/finding=periodic_disturbance:1/);
  // The checks that it rests on light up in the grid.
  if (found.findings[0].because.length > 0) {
    await page.getByRole('button', {name: 'Mark them'}).first().click();
    await page.waitForURL(/lit=periodic_disturbance:1/);
    assert.equal(await panel(page, 'Checks').locator('circle.lit').count(), found.checks.filter(check => found.findings[0].because.some(id => check.id.endsWith(id))).length);
    await page.goBack();
    await page.waitForURL(url => !url.search.includes('lit'));
  }
  await figure.getByText(/black: Periodic disturbance, 1?[73]\.[37] Hz/).waitFor();
  if (found.findings[0].rivals.length > 0) await page.getByText(/Rivals and their evidence/).first().waitFor();
  await page.reload();
  await page.locator('tbody.finding details[open]').waitFor();
  await page.goBack();
  await page.waitForURL(url => !url.search.includes('finding'));
  await closed(page);
});

test('what was just answered is sent with the others, however late the daemon looks at it', async () => {
  const page = await open(browser, daemon, '/upload');
  const held = [];
  let hold = false;
  await page.route('**/v1/recordings/preview*', async route => { if (hold) await new Promise(go => held.push(go)); await route.continue(); });
  const file = (name, seed) => ({name, mimeType: 'text/csv', buffer: Buffer.from(csv(400, seed))});
  await page.locator('input[type=file]').setInputFiles([file('early.csv', 76), file('late.csv', 77)]);
  await page.getByText('2 need an answer').waitFor();
  hold = true;
  for (const name of ['early.csv', 'late.csv']) await page.getByLabel(`Rate in Hz of ${name}`, {exact: true}).fill('100');
  while (held.length < 2) await page.waitForTimeout(20);
  held[0]();
  await page.getByText('2 ready').waitFor();
  await page.getByRole('button', {name: 'Upload only'}).click();
  await page.getByText('2 stored').waitFor();
  for (const release of held) release();
  await closed(page);
});

test('what needs an answer is counted, and is not sent with what is clear', async () => {
  const file = (name, text) => ({name, mimeType: 'text/plain', buffer: Buffer.from(text)});
  const page = await open(browser, daemon, '/upload');
  await page.locator('input[type=file]').setInputFiles([file('clear.csv', csv(400, 75)), file('letters.csv', 'this is\nno table\n')]);
  await page.getByLabel('Rate in Hz of clear.csv').fill('100');
  await page.getByText('1 ready, 1 needs an answer').waitFor();
  await page.getByRole('button', {name: 'Upload only'}).click();
  await page.getByText('1 needs an answer, 1 stored').waitFor();
  assert.equal((await daemon.json('/v1/recordings?device=letters')).items?.length ?? 0, 0);
  await closed(page);
});
