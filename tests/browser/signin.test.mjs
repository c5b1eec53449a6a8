// A daemon that asks for tokens: its pages ask for one, keep nothing of it, and sign out again.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {Daemon, PATIENCE_MS, accessibilityFaults, launch, open} from './world.mjs';

let browser;
let daemon;
let secret;

before(async () => {
  browser = await launch();
  daemon = await Daemon.start(undefined, 0, ['--require-tokens']);
  secret = readFileSync(join(daemon.data, 'first-admin-token'), 'utf8').trim();
});
after(async () => { await browser?.close(); await daemon?.end(); });

test('a token is exchanged for a session that scripts cannot read, and signing out ends it', {timeout: PATIENCE_MS}, async () => {
  const page = await browser.newPage();
  await page.goto(`${daemon.address}/devices`);
  const field = page.getByLabel('Token');
  await field.waitFor();
  assert.deepEqual(await accessibilityFaults(page), []);

  await field.fill('dl_no-token-at-all');
  await page.getByRole('button', {name: 'Sign in'}).click();
  await page.getByRole('alert').waitFor();

  await field.fill(` ${secret} `);
  await page.getByRole('button', {name: 'Sign in'}).click();
  const signOut = page.getByRole('button', {name: 'Sign out'});
  await signOut.waitFor();
  assert.ok(await page.evaluate(token => !document.cookie && !Object.values(localStorage).join().includes(token) && !document.body.innerHTML.includes(token), secret));
  const [cookie] = await page.context().cookies();
  assert.deepEqual([cookie.httpOnly, cookie.sameSite], [true, 'Strict']);
  const made = await page.evaluate(async () => (await fetch('/v1/devices', {method: 'POST', headers: {'Content-Type': 'application/json'}, body: '{"name": "made-here"}'})).status);
  assert.equal(made, 201);

  await signOut.click();
  await page.getByLabel('Token').waitFor();
  assert.equal((await page.context().cookies()).length, 0);
  await page.close();
});

test('a token that expires under an open page asks again, and leads back to where the reader was', {timeout: 2 * PATIENCE_MS}, async () => {
  const admin = {Authorization: `Bearer ${secret}`};
  const LASTS_S = 12;
  await daemon.json('/v1/devices', {name: 'kept-device'}, admin);
  const short = (await daemon.json('/v1/tokens', {name: 'screen in the hall', scope: 'read', expires_in_s: LASTS_S}, admin)).secret;
  const made = Date.now();
  const page = await open(browser, daemon, '/devices?q=kept');
  await page.getByLabel('Token').fill(short);
  await page.getByRole('button', {name: 'Sign in'}).click();
  await page.getByRole('rowheader', {name: 'kept-device'}).waitFor();
  page.loud.length = 0;  // the refusal with which the page began
  assert.ok(Date.now() - made < 1000 * LASTS_S, 'the token lasted until the page was there');
  // Nobody touches anything: the page finds out by itself.
  await page.getByLabel('Token').waitFor({timeout: PATIENCE_MS});
  assert.ok(Date.now() - made > 1000 * LASTS_S - 1000, 'not before its time');
  assert.equal(await page.getByText('kept-device').count(), 0, 'nothing of the lab is left on the screen');
  await page.getByLabel('Token').fill(short);
  await page.getByRole('button', {name: 'Sign in'}).click();
  await page.getByRole('alert').waitFor();  // it stays expired
  await page.getByLabel('Token').fill(secret);
  await page.getByRole('button', {name: 'Sign in'}).click();
  await page.getByRole('rowheader', {name: 'kept-device'}).waitFor();
  assert.match(page.url(), /\/devices\?q=kept$/);
  assert.deepEqual(page.loud.filter(text => !/status of 40[13]/.test(text)), []);
  await page.context().close();
});
