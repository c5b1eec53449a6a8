// What is done with recordings that are chosen, and what a reader changes of one: labels, and whether it is kept.
import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {Daemon, csv, launch, open} from './world.mjs';

let browser;
let daemon;
before(async () => { browser = await launch(); daemon = await Daemon.start(); });
after(async () => { await browser?.close(); await daemon?.end(); });

const closed = async page => { assert.deepEqual(page.loud, []); await page.context().close(); };
const upload = async (device, count) => {
  const ids = [];
  for (let i = 0; i < count; ++i) ids.push((await daemon.upload(csv(4000, 70 + i), {device, condition: 'static', rate_hz: 100, id: `${device}-${i}`})).id);
  return ids;
};
const chosenOf = page => (new URL(page.url()).searchParams.get('chosen') ?? '').split(',').filter(Boolean);

test('recordings are chosen one by one and in a row, and the choice outlives reload and Back', async () => {
  const ids = await upload('many', 4);
  const page = await open(browser, daemon, '/devices/many');
  await page.getByLabel('Choose many-3').check();
  const bar = page.getByRole('group', {name: 'Chosen recordings'});
  await bar.getByText('1 chosen').waitFor();
  assert.equal(await bar.getByRole('link', {name: 'Compare'}).count(), 0, 'one alone is not compared');
  await page.getByLabel('Choose many-1').click({modifiers: ['Shift']});
  await bar.getByText('3 chosen').waitFor();
  assert.deepEqual(chosenOf(page).sort(), ids.slice(1).sort());
  await page.goBack();
  await bar.getByText('1 chosen').waitFor();
  await page.goForward();
  await bar.getByText('3 chosen').waitFor();
  await page.reload();
  await bar.getByText('3 chosen').waitFor();
  assert.ok(await page.getByLabel('Choose many-2').isChecked());
  await page.getByLabel('Choose many-2').uncheck();
  await bar.getByText('2 chosen').waitFor();
  await bar.getByRole('button', {name: 'Characterise'}).click();
  await page.waitForURL(/\/jobs\/job_/);
  await page.goBack();
  await bar.getByRole('link', {name: 'Compare'}).click();
  await page.waitForURL(/\/compare\?with=/);
  await page.goBack();
  // A finger's long press is the menu of a mouse, which stays the browser's.
  const pressed = pointerType => page.locator('.list-of-recordings tr', {hasText: 'many-2'}).evaluate((row, kind) => row.dispatchEvent(new PointerEvent('contextmenu', {bubbles: true, cancelable: true, pointerType: kind})), pointerType);
  assert.equal(await pressed('mouse'), true);
  assert.equal(await pressed('touch'), false);
  await bar.getByText('3 chosen').waitFor();
  await bar.getByRole('button', {name: 'Choose none'}).click();
  await bar.waitFor({state: 'detached'});
  await closed(page);
});

test('deleting what is chosen asks once, names it and leaves the rest', async () => {
  await upload('spare', 3);
  const page = await open(browser, daemon, '/devices/spare');
  await page.getByLabel('Choose spare-0').check();
  await page.getByLabel('Choose spare-2').check();
  const bar = page.getByRole('group', {name: 'Chosen recordings'});
  await bar.getByRole('button', {name: 'Delete'}).click();
  const dialog = page.getByRole('dialog');
  await dialog.getByText(/spare-0, spare-2: with their files and results/).waitFor();
  await dialog.getByRole('button', {name: 'Keep'}).click();
  await bar.getByText('2 chosen').waitFor();
  await bar.getByRole('button', {name: 'Delete'}).click();
  await dialog.getByRole('button', {name: 'Delete'}).click();
  await page.getByText('2 recordings are deleted.').waitFor();
  await bar.waitFor({state: 'detached'});
  await page.locator('.list-of-recordings tbody tr').nth(1).waitFor({state: 'detached'});
  assert.deepEqual((await daemon.json('/v1/recordings?device=spare')).items.map(each => each.metadata.id), ['spare-1']);
  await closed(page);
});

test('a recording is deleted on its page, and its device only when nothing depends on it', async () => {
  await upload('single', 1);
  const page = await open(browser, daemon, '/devices/single', {absent: [/\/v1\/recordings\/rec_/, /\/v1\/devices\//]});
  await page.getByRole('button', {name: 'Delete'}).click();
  await page.getByRole('dialog').getByRole('button', {name: 'Delete'}).click();
  await page.getByRole('alert').getByText(/recording/).waitFor();
  page.loud = page.loud.filter(line => !/409/.test(line));
  await page.getByRole('link', {name: 'single-0'}).click();
  await page.getByRole('heading', {level: 1, name: 'single-0'}).waitFor();
  await page.getByRole('button', {name: 'Delete'}).click();
  await page.getByRole('dialog').getByRole('button', {name: 'Delete'}).click();
  await page.waitForURL(/\/devices\/single$/);
  await page.getByRole('button', {name: 'Delete'}).click();
  await page.getByRole('dialog').getByRole('button', {name: 'Delete'}).click();
  await page.waitForURL(/\/devices$/);
  assert.deepEqual((await daemon.json('/v1/devices')).items.filter(each => each.name === 'single'), []);
  await closed(page);
});

test('labels are changed in place; what the daemon refuses is taken back and stays typed', async () => {
  const [id] = await upload('named', 1);
  const page = await open(browser, daemon, `/recordings/${id}`, {absent: [/\/v1\/recordings\/rec_/]});
  await page.getByRole('button', {name: 'Change labels'}).click();
  const field = page.getByLabel('Labels, name=value');
  await field.fill('firmware=1.5.0, batch=7');
  await page.getByRole('button', {name: 'Save'}).click();
  await page.getByText('firmware=1.5.0, batch=7').waitFor();
  await field.waitFor({state: 'detached'});
  assert.deepEqual((await daemon.json(`/v1/recordings/${id}`)).metadata.labels, {firmware: '1.5.0', batch: '7'});
  await page.reload();
  await page.getByText(/batch=7/).waitFor();
  await page.getByRole('button', {name: 'Change labels'}).click();
  await field.fill('firmware');
  await page.getByRole('button', {name: 'Save'}).click();
  await page.getByRole('alert').waitFor();
  assert.equal(await field.inputValue(), 'firmware');
  assert.deepEqual((await daemon.json(`/v1/recordings/${id}`)).metadata.labels, {firmware: '1.5.0', batch: '7'});
  await field.press('Escape');
  await page.getByText(/firmware=1\.5\.0/).waitFor();
  await page.getByRole('button', {name: 'Change labels'}).click();
  await field.fill('');
  await page.getByRole('button', {name: 'Save'}).click();
  await field.waitFor({state: 'detached'});
  assert.equal((await daemon.json(`/v1/recordings/${id}`)).metadata.labels, undefined);
  await closed(page);
});
