// Populations, data sheets, webhooks and recorded drives, as somebody of the lab uses their pages.
import assert from 'node:assert/strict';
import {createHmac} from 'node:crypto';
import {after, before, test} from 'node:test';
import {fillDrive, fillLine, receiver} from './lab.mjs';
import {Daemon, csv, launch, open} from './world.mjs';

let browser;
let daemon;
let line;
let drive;

before(async () => {
  browser = await launch();
  daemon = await Daemon.start(undefined, undefined, ['--webhook-allow', '127.0.0.1']);
});
after(async () => { await browser?.close(); await daemon?.end(); });

const closed = async page => {
  assert.deepEqual(page.loud, []);
  await page.context().close();
};
const visible = (page, text) => page.getByText(text).first().waitFor();

test('where there is nothing yet, each page says what it would show and how it comes', async () => {
  const page = await open(browser, daemon, '/populations', {absent: [/none-such/, /whk_none/, /drv_none/, /job_none/]});
  await visible(page, 'No device states its model');
  for (const [path, text] of [['/drives', 'A drive is one recording of an inertial unit'], ['/webhooks', 'None yet.'], ['/data-sheets/none-such', 'No known sensor is named']]) {
    await page.goto(daemon.address + path);
    await visible(page, text);
  }
  for (const path of ['/populations/none-such', '/webhooks/whk_none', '/drives/drv_none', '/drive-evaluations/job_none']) {
    await page.goto(daemon.address + path);
    await page.getByRole('alert').first().waitFor();
  }
  await closed(page);
});

test('keys and tabs lead to pages that the bar has no room for', async () => {
  const page = await open(browser, daemon, '/');
  await page.getByText('Drop a recording of a sensor').first().waitFor();
  for (const [key, title, current] of [['p', 'Populations', 'Devices'], ['s', 'Data sheets', 'Devices'], ['v', 'Recorded drives', 'Outages'], ['w', 'Webhooks', 'Jobs']]) {
    await page.keyboard.press('g');
    await page.keyboard.press(key);
    await page.getByRole('heading', {name: title, level: 1}).waitFor();
    assert.equal(await page.locator('.bar [aria-current=page]').innerText(), current);
    assert.equal(await page.locator('.tabs [aria-current=page]').innerText(), title);
  }
  await page.locator('.tabs').getByText('Jobs').click();
  await page.getByRole('heading', {name: 'Jobs', level: 1}).waitFor();
  await closed(page);
});

test('the device that is not of the line is named, and the address holds the view', async () => {
  line = await fillLine(daemon);
  const odd = line.devices[line.devices.length - 1];
  const page = await open(browser, daemon, '/populations');
  await page.getByRole('row', {name: new RegExp(`${line.model}.*${odd}`)}).waitFor();
  await page.getByRole('link', {name: line.model}).first().click();
  assert.match(await page.locator('.verdict').innerText(), new RegExp(`One of 8 devices is not of the line: ${odd}`));
  const figure = page.locator('section.panel', {has: page.getByRole('heading', {name: 'White noise N'})});
  await figure.locator('svg[role=img]').focus();
  await page.keyboard.press('End');
  await figure.locator('.readout', {hasText: odd}).waitFor();
  await page.getByRole('button', {name: 'By name'}).click();
  await page.waitForURL(/order=name/);
  await page.reload();
  await page.getByRole('button', {name: 'By name', pressed: true}).waitFor();
  assert.equal(await page.locator('tbody th a').first().innerText(), line.devices[0]);
  await page.goBack();
  await page.getByRole('button', {name: 'By value', pressed: true}).waitFor();
  await page.locator('tbody').getByRole('link', {name: line.devices[0]}).click();
  await visible(page, 'times the 1.27 deg/√h of the data sheet: agrees');
  await page.getByRole('link', {name: line.model}).last().click();
  await page.waitForURL(new RegExp(`/data-sheets/${line.model}$`));
  await visible(page, 'mechanical characteristics');
  await closed(page);
});

test('a sensor is found however it is spelt', async () => {
  const page = await open(browser, daemon, '/data-sheets');
  await page.getByLabel('Find a sensor or manufacturer').fill('mpu 6050');
  await page.waitForURL(/q=mpu/);
  await page.getByRole('link', {name: 'MPU-6050'}).waitFor();
  assert.equal(await page.locator('tbody tr').count(), 1);
  await page.getByLabel('Find a sensor or manufacturer').fill('HG1700');
  await visible(page, 'No sensor known here');
  await closed(page);
});

test('a receiver is added, tried, paused and deleted; its secret is shown once', async () => {
  const listens = await receiver(204);
  const page = await open(browser, daemon, '/webhooks', {absent: [/\/v1\/webhooks$/]});
  await page.getByLabel('address').fill('http://10.1.2.3/hook');
  await page.getByLabel('for whom').fill('nightly');
  await page.getByRole('button', {name: 'Add'}).click();
  await page.getByRole('alert').waitFor();
  assert.equal(await page.getByLabel('for whom').inputValue(), 'nightly', 'what was typed is lost');
  await page.getByLabel('address').fill(listens.url);
  await page.getByLabel('investigations').uncheck();
  await page.getByRole('button', {name: 'Add'}).click();
  const secret = await page.getByRole('region', {name: 'Secret'}).locator('code').innerText();
  assert.match(secret, /^whsec_[A-Za-z0-9+/]{43}=$/);
  const kept = await page.evaluate(() => JSON.stringify([{...localStorage}, {...sessionStorage}, location.href]));
  assert.ok(!kept.includes(secret), 'the secret is kept');
  await page.reload();
  await page.getByRole('link', {name: /127\.0\.0\.1/}).waitFor();
  assert.ok(!(await page.content()).includes(secret), 'the secret is shown again');
  await page.getByRole('link', {name: /127\.0\.0\.1/}).click();
  await visible(page, 'It hears of regressions and all other jobs.');
  await page.getByRole('button', {name: 'Send a test'}).click();
  await page.getByRole('row', {name: /webhook\.test.*arrived/}).waitFor();
  const [message] = listens.messages;
  const content = `${message.headers['webhook-id']}.${message.headers['webhook-timestamp']}.${message.body}`;
  assert.equal(message.headers['webhook-signature'], `v1,${createHmac('sha256', Buffer.from(secret.slice(6), 'base64')).update(content).digest('base64')}`);
  await page.getByRole('button', {name: 'Given up'}).click();
  await page.waitForURL(/state=given_up/);
  await visible(page, 'None in this state.');
  await page.goBack();
  await page.getByRole('button', {name: 'Pause'}).click();
  await visible(page, 'Paused: nothing is told');
  await page.getByRole('button', {name: 'Enable again'}).click();
  await page.getByRole('button', {name: 'Pause'}).waitFor();
  await page.getByRole('button', {name: 'New secret'}).click();
  assert.notEqual(await page.getByRole('region', {name: 'Secret'}).locator('code').innerText(), secret);
  await visible(page, 'signs beside the new one');
  await page.getByRole('button', {name: 'Delete'}).click();
  await page.getByRole('dialog').getByRole('button', {name: 'Keep'}).click();
  await page.getByRole('button', {name: 'Delete'}).click();
  await page.getByRole('dialog').getByRole('button', {name: 'Delete'}).click();
  await page.waitForURL(/\/webhooks$/);
  await visible(page, 'None yet.');
  listens.close();
  await closed(page);
});

test('a drive is asked on its page, and the answer says what is wrong and what mending gains', async () => {
  drive = await fillDrive(daemon);
  const page = await open(browser, daemon, '/drives');
  await page.getByRole('link', {name: 'town'}).first().click();
  await visible(page, /km in 10 min, .* 600 fixes at 1 Hz/);
  await page.getByLabel('question').selectOption('run');
  await page.getByLabel('it moves along its nose').check();
  await page.getByRole('button', {name: 'Ask'}).click();
  await page.waitForURL(/\/drive-evaluations\/job_/);
  await page.locator('.verdict', {hasText: 'without fixes the filter is'}).waitFor();
  await visible(page, /The heading is known to 1° from .+ on\./);
  await page.goto(`${daemon.address}/drive-evaluations/${drive.explain}`);
  await page.getByRole('heading', {name: 'Causes found'}).waitFor();
  const text = await page.locator('main').innerText();
  assert.match(text, /Velocities of fixes are late by 0\.4/);
  assert.doesNotMatch(text, /\b[a-z]+_[a-z_]+\b/, 'a name that only documents use');
  await page.getByRole('button', {name: '20 s'}).click();
  await page.waitForURL(/duration=20/);
  await page.getByRole('heading', {name: 'Every outage of 20 s'}).waitFor();
  await page.getByRole('heading', {name: 'Error in outages of 20 s'}).waitFor();
  await visible(page, 'simulated, as it was');
  const map = page.locator('svg.where');
  const {evaluation: {after, path}} = await daemon.json(`/v1/drive-evaluations/${drive.explain}`);
  const shown = after.durations.find(each => each.duration_s === 20);
  assert.equal(await map.locator('ellipse').count(), shown.n, 'an ellipse for each outage');
  assert.equal((await map.locator('polyline').getAttribute('points')).split(' ').length, path.east_m.length);
  await page.keyboard.press(']');
  await page.getByRole('heading', {name: 'Every outage of 30 s'}).waitFor();
  await page.goBack();
  await page.getByRole('heading', {name: 'Every outage of 20 s'}).waitFor();
  await page.getByRole('button', {name: 'As it was'}).click();
  await page.waitForURL(/side=before/);
  await page.reload();
  await page.getByRole('button', {name: 'As it was', pressed: true}).waitFor();
  await page.getByRole('heading', {name: 'Every outage of 20 s'}).waitFor();
  await closed(page);
});

test('names that are markup stay text on these pages too', async () => {
  const evil = '<img src=x onerror="window.hurt=1">';
  await daemon.json('/v1/devices', {name: 'odd-01', model: evil});
  const recording = await daemon.upload(csv(6000, 3), {device: 'odd-01', condition: 'static', rate_hz: '100'});
  await daemon.characterise(recording.id);
  const page = await open(browser, daemon, '/populations');
  await page.getByRole('link', {name: evil}).first().click();
  await page.getByRole('heading', {name: evil, level: 1}).waitFor();
  await page.getByRole('heading', {name: 'Devices', exact: true}).waitFor();
  assert.equal(await page.evaluate(() => window.hurt), undefined);
  assert.equal(await page.locator('main img').count(), 0);
  await closed(page);
});

test('a daemon that goes away leaves the page readable and what was typed', async () => {
  const page = await open(browser, daemon, '/webhooks');
  await page.getByLabel('for whom').fill('later');
  await daemon.stop();
  await page.getByText('The daemon does not answer.').first().waitFor();
  assert.equal(await page.getByLabel('for whom').inputValue(), 'later');
  await page.context().close();
});
