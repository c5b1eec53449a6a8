// A day in the lab, in a real browser before the real daemon.
import assert from 'node:assert/strict';
import {readFileSync, rmSync, utimesSync, writeFileSync} from 'node:fs';
import {after, before, test} from 'node:test';
import {Daemon, csv, launch, open} from './world.mjs';

let browser;
let daemon;
before(async () => { browser = await launch(); daemon = await Daemon.start(); });
after(async () => { await browser?.close(); await daemon?.end(); });

const visible = (page, text) => page.getByText(text).first().waitFor();

test('an empty lab notices an upload from elsewhere', async () => {
  const other = await Daemon.start();
  const page = await open(browser, other, '/');
  await visible(page, 'Drop a recording of a sensor at rest; you get its noise model.');
  await other.upload(csv(4000, 2), {device: 'from-the-bench', condition: 'static', rate_hz: 100});
  await page.getByRole('rowheader', {name: 'from-the-bench'}).waitFor();
  assert.match(await page.getByRole('row', {name: /from-the-bench/}).innerText(), /not characterised/);
  const [recording] = (await other.json('/v1/recordings')).items;
  await other.characterise(recording.id);
  await page.getByRole('row', {name: /from-the-bench/}).locator('a[href^="/recordings/"]').waitFor();  // the row follows without a reload
  assert.deepEqual(page.loud, []);
  await page.context().close();
  await other.end();
});

test('two files of one device end on its figures, files of several devices in the Lab', async () => {
  const page = await open(browser, daemon, '/upload');
  const file = (name, seed) => ({name, mimeType: 'text/csv', buffer: Buffer.from(csv(6000, seed))});
  await page.locator('input[type=file]').setInputFiles([file('pair-1.csv', 21), file('pair-2.csv', 22)]);
  for (const name of ['pair-1.csv', 'pair-2.csv']) {
    await page.getByLabel(`Device of ${name}`, {exact: true}).fill('pair');
    await page.getByLabel(`Rate in Hz of ${name}`).fill('100');
  }
  await page.getByRole('button', {name: 'Upload two and characterise'}).click();
  await page.waitForURL(/\/devices\/pair$/);
  await page.getByRole('heading', {name: 'Parameters by condition'}).waitFor();
  await page.getByText('2 recordings').first().waitFor();
  await page.goBack();
  for (const [name, device] of [['left.csv', 'left'], ['right.csv', 'right']]) {
    await page.locator('input[type=file]').setInputFiles(file(name, name.length + 30));
    await page.getByLabel(`Device of ${name}`, {exact: true}).fill(device);
    await page.getByLabel(`Rate in Hz of ${name}`).fill('100');
  }
  await page.getByRole('button', {name: 'Upload two and characterise'}).click();
  await page.waitForURL(url => url.pathname === '/');
  await page.getByRole('rowheader', {name: 'right'}).waitFor();
  assert.deepEqual(page.loud, []);
  await page.context().close();
});

test('a refusal is repaired in place, and the recording ends in a figure that is a file of its own', async () => {
  const page = await open(browser, daemon, '/upload', {absent: [/\/v1\/recordings\?device=bench-01/]});
  await page.locator('input[type=file]').setInputFiles({name: 'bench gyro.csv', mimeType: 'text/csv', buffer: Buffer.from(csv(6000))});
  await page.getByLabel('Device of bench gyro.csv').fill('bench-01');
  await page.getByRole('button', {name: /^Upload .*and characterise/}).click();
  await page.getByLabel('Rate in Hz that repairs bench gyro.csv').fill('100');
  assert.equal(await page.getByLabel('Device of bench gyro.csv').inputValue(), 'bench-01', 'what was typed is lost');
  await page.getByRole('button', {name: /^Upload .*and characterise/}).click();
  await page.waitForURL(/\/recordings\/rec_/);
  await page.getByRole('heading', {name: 'Ranking'}).waitFor();
  await page.locator('.verdict', {hasText: /describes this recording|does not/}).waitFor();
  const figure = page.locator('section.panel', {has: page.getByRole('heading', {name: 'Allan deviation'})});
  const [download] = await Promise.all([page.waitForEvent('download'), figure.getByRole('button', {name: 'SVG'}).click()]);
  const svg = readFileSync(await download.path(), 'utf8');
  assert.match(download.suggestedFilename(), /allan\.svg$/);
  assert.match(svg, /^<svg [^>]*xmlns="http:\/\/www\.w3\.org\/2000\/svg"/);
  assert.match(svg, /<title>Allan deviation\./);
  assert.match(svg, /driftlab \d+\.\d+\.\d+, rec_/);
  assert.doesNotMatch(svg, /var\(--|data-cursor|<script/);
  const [table] = await Promise.all([page.waitForEvent('download'), figure.getByRole('button', {name: 'CSV'}).click()]);
  assert.match(readFileSync(await table.path(), 'utf8').split('\n')[0], /averaging time τ, s|classical/);
  assert.deepEqual(page.loud, []);
  await page.context().close();
});

test('what the first values say of units and condition is said before anything is sent', async () => {
  const page = await open(browser, daemon, '/upload');
  const rows = Array.from({length: 400}, (_, i) => `0.01,-0.02,${(9 + 0.01 * (i % 7)).toFixed(3)},0.1,0.2,${(9.8 + 0.001 * (i % 5)).toFixed(4)}`).join('\n');
  await page.locator('input[type=file]').setInputFiles({name: 'table.csv', mimeType: 'text/csv', buffer: Buffer.from(`gx [deg/s],gy [deg/s],gz [deg/s],ax [g],ay [g],az [g]\n${rows}\n`)});
  await page.getByText(/length of .* is 9\.8\d* g, where gravity is 1(\.0*)? g: these columns look like m\/s²/).waitFor();
  await page.getByText(/The gyroscope about z reads 9\.0\d deg\/s and hardly changes\. The condition says that it is at rest\./).waitFor();
  await page.getByText('The condition says that it is at rest').scrollIntoViewIfNeeded();
  await page.getByRole('button', {name: 'Say so'}).click();
  assert.equal(await page.getByLabel('Condition of table.csv', {exact: true}).inputValue(), 'constant_rate');
  assert.equal(await page.getByLabel('Condition of table.csv: deg/s').inputValue(), '9');
  await page.getByText('The condition says').waitFor({state: 'detached'});
  await page.getByText('where gravity is').waitFor({state: 'detached'});
  // What would refuse the upload stands there already, beside the field that mends it; nothing is stored by looking.
  await page.getByLabel('Rate in Hz that repairs table.csv').fill('100');
  // What is typed survives that the list is drawn again before the field is left.
  await page.locator('input[type=file]').setInputFiles({name: 'another.csv', mimeType: 'text/csv', buffer: Buffer.from(csv(100, 5))});
  await page.getByRole('button', {name: 'another.csv', exact: true}).waitFor();
  assert.equal(await page.getByLabel('Rate in Hz that repairs table.csv').inputValue(), '100');
  await page.getByLabel('Rate in Hz that repairs table.csv').blur();
  await page.getByRole('button', {name: 'Remove another.csv'}).click();
  await visible(page, '6 columns read');
  const device = await page.getByLabel('Device of table.csv').inputValue();
  assert.equal((await fetch(`${daemon.address}/v1/devices/${device}`)).status, 404);
  await page.getByRole('row', {name: /^gz \[deg\/s\] .*angular rate.* z .*deg\/s .*read from the header/}).waitFor();
  assert.deepEqual(page.loud, []);
  await page.context().close();
});

test('a column that rises as a time does is proposed as one', async () => {
  const page = await open(browser, daemon, '/upload');
  const rows = Array.from({length: 300}, (_, i) => `${i * 4},${(0.01 * (i % 7)).toFixed(3)}`).join('\n');
  await page.locator('input[type=file]').setInputFiles({name: 'table of turns.csv', mimeType: 'text/csv', buffer: Buffer.from(`all_time,gz [deg/s]\n${rows}\n`)});
  await visible(page, 'Column all_time rises as a time in ms does, at 250 Hz.');
  await page.getByRole('button', {name: 'It is the time'}).click();
  await visible(page, '2 columns read');
  assert.equal(await page.getByLabel('Quantity of all_time').inputValue(), 'time');
  assert.equal(await page.getByLabel('Unit of all_time').inputValue(), 'ms');
  assert.equal(await page.getByLabel('Quantity of gz [deg/s]').inputValue(), 'angular_rate');
  assert.equal(await page.getByLabel('Rate in Hz of table of turns.csv').getAttribute('placeholder'), '250');
  assert.deepEqual(page.loud, []);
  await page.context().close();
});

test('the address holds the view: back undoes, reload restores, a second tab shows the same', async () => {
  const [recording] = (await daemon.json('/v1/recordings?sort=-created_at')).items;
  const page = await open(browser, daemon, `/recordings/${recording.id}`);
  await page.getByRole('button', {name: 'Haar wavelet'}).click();
  await page.waitForURL(/curve=haar/);
  await page.getByRole('combobox', {name: 'Unit'}).selectOption('rad/s');
  await page.waitForURL(/unit=rad/);
  await page.goBack();
  assert.doesNotMatch(page.url(), /unit=/);
  await page.reload();
  await page.getByRole('heading', {name: 'Haar wavelet deviation'}).waitFor();
  const figure = page.locator('section.panel', {has: page.getByRole('heading', {name: 'Haar wavelet deviation'})}).locator('svg[role=img]');
  await figure.focus();
  await page.keyboard.press('Home');
  await page.keyboard.press('ArrowRight');
  await page.waitForURL(/tau=/);
  assert.match(await page.locator('.readout', {hasText: 'τ '}).first().innerText(), /τ 0\.02.*classical/s);
  await page.locator('.readout', {hasText: /f 2[3-6][.0-9]* Hz.*measured/s}).waitFor();  // the spectrum shows the same place
  const other = await open(browser, daemon, new URL(page.url()).pathname + new URL(page.url()).search);
  await other.getByRole('heading', {name: 'Haar wavelet deviation'}).waitFor();
  await other.locator('.readout', {hasText: 'τ 0.02'}).waitFor();
  await page.keyboard.press('Escape');
  await page.waitForURL(url => !url.search.includes('tau='));
  assert.deepEqual([...page.loud, ...other.loud], []);
  await page.context().close();
  await other.context().close();
});

test('a large upload goes in pieces, is paused, survives a reload and goes on where it was', async () => {
  const page = await open(browser, daemon, '/upload');
  const file = {name: 'long bench.csv', mimeType: 'text/csv', buffer: Buffer.from(csv(1900000, 11))};
  const sent = [];
  page.on('request', request => { if (request.method() === 'PATCH') sent.push(Number(request.headers()['upload-offset'])); });
  let release;
  const paused = new Promise(resolve => { release = resolve; });
  await page.route('**/v1/uploads/*', async route => { if (route.request().method() === 'PATCH' && sent.length === 2) await paused; await route.continue(); });
  const [path, stamp] = [`/tmp/driftlab-long-${process.pid}.csv`, new Date(1700000000000)];
  writeFileSync(path, file.buffer);
  utimesSync(path, stamp, stamp);
  await page.locator('input[type=file]').setInputFiles(path);
  await page.getByLabel(/^Rate in Hz of/).fill('100');
  await page.getByRole('button', {name: 'Upload only'}).click();
  while (sent.length < 2) await page.waitForTimeout(20);  // the first piece is stored, the second on its way
  await page.getByRole('button', {name: /^Pause/}).click();
  release();
  await page.getByText(/^paused at/).waitFor();
  await page.reload();
  await page.locator('input[type=file]').setInputFiles(path);
  await page.getByLabel(/^Rate in Hz of/).fill('100');
  await page.getByRole('button', {name: 'Upload only'}).click();
  await page.getByRole('link', {name: 'stored'}).waitFor();
  rmSync(path);
  assert.deepEqual(sent.slice(0, 3), [0, 8 * 2 ** 20, 8 * 2 ** 20], `${sent} were the offsets`);
  assert.deepEqual(page.loud, []);
  await page.context().close();
});

test('what people name things is text on every page', async () => {
  const evil = '<img src=x onerror="window.hurt=1">';
  const recording = await daemon.upload(csv(4000, 7), {device: evil, condition: 'static', rate_hz: 100, id: evil});
  await daemon.characterise(recording.id);
  const page = await open(browser, daemon, `/recordings/${recording.id}`);
  await page.getByRole('heading', {level: 1, name: evil}).waitFor();
  for (const path of ['/', '/devices', `/devices/${encodeURIComponent(evil)}`, '/compare']) {
    await page.goto(daemon.address + path);
    await page.getByText(evil, {exact: false}).first().waitFor({state: 'attached'});
    assert.equal(await page.locator('img').count(), 0, path);
  }
  assert.equal(await page.evaluate(() => window.hurt), undefined);
  assert.deepEqual(page.loud, []);
  await page.context().close();
});

test('keys lead everywhere and the find field finds', async () => {
  const page = await open(browser, daemon, '/jobs');
  await page.getByRole('heading', {level: 1, name: 'Jobs'}).waitFor();
  await page.keyboard.press('/');
  await page.keyboard.type('bench');
  await page.getByRole('option', {name: /^bench-01/}).waitFor();  // before its recordings
  await page.keyboard.press('Enter');
  await page.waitForURL(/\/devices\/bench-01/);
  await page.keyboard.press('g');
  await page.keyboard.press('l');
  await page.getByRole('heading', {level: 1, name: 'Lab'}).waitFor();
  await page.keyboard.press('?');
  await page.getByRole('dialog', {name: 'Keys'}).waitFor();
  await page.keyboard.press('Escape');
  assert.equal(await page.getByRole('dialog').count(), 0);
  assert.deepEqual(page.loud, []);
  await page.context().close();
});

test('a daemon that restarts under an open page is waited for, and nothing is lost', async () => {
  const page = await open(browser, daemon, '/devices/bench-01');
  await page.getByRole('heading', {name: 'Parameters by condition'}).waitFor();
  const {data, port} = daemon;
  page.away = true;
  await daemon.stop('SIGKILL');
  await page.locator('.offline', {hasText: 'The daemon does not answer. Trying again in 5 s.'}).waitFor();
  assert.ok(await page.getByRole('heading', {name: 'Parameters by condition'}).isVisible(), 'the page stays readable');
  daemon = await Daemon.start(data, port);
  await page.locator('.offline').waitFor({state: 'detached'});
  await page.getByRole('link', {name: 'Jobs', exact: true}).click();
  await page.getByRole('cell', {name: /succeeded/}).first().waitFor();
  assert.deepEqual(page.loud, []);
  await page.context().close();
});

test('a job that cannot succeed says why where it stands', async () => {
  const recording = await daemon.upload(csv(40, 3), {device: 'short', condition: 'static', rate_hz: 100});
  const job = await daemon.characterise(recording.id);
  const page = await open(browser, daemon, `/jobs/${job.id}`, {absent: [/rec_0{26}/, /\/v1\/devices\/nobody/]});
  await page.locator('.verdict').waitFor();
  if (job.state === 'failed') await page.locator('.verdict', {hasText: job.problem.detail.slice(0, 30)}).waitFor();
  await page.goto(`${daemon.address}/recordings/rec_00000000000000000000000000`);
  await page.getByRole('alert').waitFor();
  await page.goto(`${daemon.address}/devices/nobody`);
  await page.getByRole('alert').waitFor();
  assert.deepEqual(page.loud, []);
  await page.context().close();
});
