// A daemon that asks for tokens: its pages ask for one, keep nothing of it, and sign out again.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {Daemon, PATIENCE_MS, accessibilityFaults, launch} from './world.mjs';

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
