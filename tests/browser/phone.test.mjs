// A phone as recorder: Chromium's emulated sensors before the real daemon.
import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {Daemon, accessibilityFaults, launch, noise, open} from './world.mjs';

let browser;
let daemon;
before(async () => { browser = await launch(); daemon = await Daemon.start(); });
after(async () => { await browser?.close(); await daemon?.end(); });

const SENSORS = ['gyroscope', 'accelerometer', 'clipboard-read', 'clipboard-write'];

// Readings of a phone at rest as often as the browser takes them; the function that ends them.
async function emulate(page, spread = 0.01) {
  const session = await page.context().newCDPSession(page);
  for (const type of ['gyroscope', 'accelerometer']) await session.send('Emulation.setSensorOverrideEnabled', {enabled: true, type, metadata: {available: true, minimumFrequency: 1, maximumFrequency: 100}});
  const rates = noise(30000, 5, spread);
  let at = 0;
  let going = true;
  const next = () => rates[at++ % rates.length];
  const loop = (async () => {
    while (going) {
      await session.send('Emulation.setSensorOverrideReadings', {type: 'gyroscope', reading: {xyz: {x: next(), y: next(), z: next()}}}).catch(() => { going = false; });
      await session.send('Emulation.setSensorOverrideReadings', {type: 'accelerometer', reading: {xyz: {x: next() * 5, y: next() * 5, z: 9.8 + next() * 5}}}).catch(() => { going = false; });
      await new Promise(resolve => setTimeout(resolve, 8));
    }
  })();
  return async () => { going = false; await loop; };
}

test('a phone at rest becomes a characterised recording, and the Allan plot grows meanwhile', async () => {
  const page = await open(browser, daemon, '/record', {permissions: SENSORS, viewport: {width: 390, height: 844}});
  const end = await emulate(page);
  await page.getByLabel('Device', {exact: true}).fill('phone-07');
  await page.getByRole('button', {name: 'Record with this device'}).click();
  await page.getByRole('heading', {level: 1, name: 'phone-07, static'}).waitFor();
  await page.getByRole('button', {name: 'Allow sensors'}).click();
  await page.getByRole('button', {name: 'Start', exact: true}).click();
  await page.getByText('lying still').waitFor();
  await page.getByRole('heading', {name: 'Allan deviation so far'}).waitFor();
  await page.getByText(/The next point, τ/).waitFor();
  assert.deepEqual(await accessibilityFaults(page), []);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth) <= 390, 'wider than the phone');
  const before = await page.locator('.live-head').innerText();
  await page.waitForTimeout(4000);
  assert.notEqual(await page.locator('.live-head').innerText(), before, 'time and samples go on');
  await page.getByRole('button', {name: 'Stop and characterise'}).click();
  await page.waitForURL(/\/recordings\/rec_/);
  await end();
  await page.getByRole('heading', {name: 'Signal'}).waitFor();
  const [recording] = (await daemon.json('/v1/recordings?sort=-created_at')).items;
  assert.equal(recording.metadata.columns.gz.unit, 'rad/s');
  assert.ok(recording.quality.samples > 100, `${recording.quality.samples} samples`);
  assert.deepEqual(page.loud, []);
  await page.context().close();
});

test('the screen beside the phone shows a code and follows what the phone records', async () => {
  const desk = await open(browser, daemon, '/record');
  await desk.getByLabel('Device', {exact: true}).fill('phone-08');
  await desk.getByRole('button', {name: 'Show a code for my phone'}).click();
  await desk.getByRole('img', {name: /code for the camera/}).waitFor();
  const address = await desk.locator('code').first().innerText();
  const word = await desk.locator('.panel b').first().innerText();
  assert.deepEqual(await accessibilityFaults(desk), []);
  const phone = await open(browser, daemon, address.slice(daemon.address.length), {permissions: SENSORS, viewport: {width: 390, height: 844}});
  const end = await emulate(phone);
  await phone.getByText(word).first().waitFor();
  await phone.getByRole('button', {name: 'Allow sensors'}).click();
  await phone.getByRole('button', {name: 'Start', exact: true}).click();
  await desk.getByRole('heading', {name: /samples/}).waitFor();
  // A page that is loaded again goes on with the same recording.
  await phone.reload();
  await phone.getByRole('button', {name: 'Allow sensors'}).click();
  await phone.getByRole('button', {name: 'Start', exact: true}).click();
  await phone.waitForTimeout(2500);
  await phone.getByRole('button', {name: 'Stop and characterise'}).click();
  await phone.waitForURL(/\/recordings\/rec_/);
  await desk.waitForURL(/\/devices\/phone-08/);
  await end();
  assert.deepEqual([...desk.loud, ...phone.loud], []);
  await desk.context().close();
  await phone.context().close();
});

test('a browser that withholds the sensors is told of in words', async () => {
  const page = await open(browser, daemon, '/record', {permissions: ['clipboard-read']});
  await page.getByLabel('Device', {exact: true}).fill('phone-09');
  await page.getByRole('button', {name: 'Record with this device'}).click();
  await page.getByRole('button', {name: 'Allow sensors'}).click();
  await page.getByText('The browser does not let this page read the sensors.').waitFor();
  assert.deepEqual(page.loud, []);
  await page.context().close();
});

test('where nothing can be recorded the page says why', async () => {
  const page = await open(browser, daemon, '/record?live=live_00000000000000000000000000#lt_none', {absent: [/live_0{26}/]});
  await page.getByText('This recording is finished, or was never begun.').waitFor();
  await page.addInitScript(() => { delete window.Gyroscope; delete window.DeviceMotionEvent; });
  await page.goto(`${daemon.address}/record`);
  await page.getByText('This browser gives pages no motion sensors.').waitFor();
  assert.ok(await page.getByRole('button', {name: 'Record with this device'}).isDisabled());
  assert.deepEqual(page.loud, []);
  await page.context().close();
});
