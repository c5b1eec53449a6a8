// What stands behind a verdict is shown where it is: in the trace, beside the margin, in the difference, while runs go on.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {after, before, test} from 'node:test';
import {Daemon, launch, noise, open} from './world.mjs';

let browser;
let daemon;
before(async () => { browser = await launch(); daemon = await Daemon.start(); });
after(async () => { await browser?.close(); await daemon?.end(); });

const RATE = 100;
const closed = async page => { assert.deepEqual(page.loud, []); await page.context().close(); };
const panel = (page, title) => page.locator('section.panel', {has: page.getByRole('heading', {name: title})});
const text = values => `gz [deg/s]\n${values.map(x => x.toFixed(6)).join('\n')}\n`;

async function recorded(values, about) {
  const made = await daemon.upload(text(values), {condition: 'static', rate_hz: RATE, columns: 'gz [deg/s]=angular_rate:z:deg/s', ...about});
  assert.equal((await daemon.characterise(made.id)).state, 'succeeded');
  return made.id;
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
  // The ratio is no surer than the two that make it: the distances of their ends on the logarithms, added in squares.
  const [first, second] = (await Promise.all(ids.slice(0, 2).map(id => daemon.json(`/v1/recordings/${id}/characterisation`)))).map(each => each.channels[0].result.allan);
  const wanted = Math.hypot(Math.log(second.ci95[0][1] / second.deviation[0]), Math.log(first.deviation[0] / first.ci95[0][0]));
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', {name: 'CSV'}).first().click()]);
  const [heading, row0] = readFileSync(await download.path(), 'utf8').split('\n').map(line => line.split(/,(?=(?:[^"]*"[^"]*")*[^"]*$)/));
  const at = heading.findIndex(name => name.includes('÷ pair-81'));
  const [value, , high] = row0.slice(at, at + 3).map(Number);
  assert.ok(at > 0 && Math.abs(Math.log(high / value) - wanted) < 1e-6, `${heading[at]}: ${value}, ${high}; ${wanted}`);
  await closed(page);
});
