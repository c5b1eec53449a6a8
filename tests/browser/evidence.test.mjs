// What stands behind a verdict is shown where it is: in the trace, beside the margin, while runs go on.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {after, before, test} from 'node:test';
import {Daemon, characterised, closed, launch, noise, open} from './world.mjs';

let browser;
let daemon;
before(async () => { browser = await launch(); daemon = await Daemon.start(); });
after(async () => { await browser?.close(); await daemon?.end(); });

const panel = (page, title) => page.locator('section.panel', {has: page.getByRole('heading', {name: title})});
const recorded = (values, about) => characterised(daemon, values, about);

test('gross errors and jumps are marked in the trace, and lead to their samples', async () => {
  const values = noise(12000, 61);
  for (const i of [3000, 3001, 9000]) values[i] += 5;
  for (let i = 6000; i < values.length; ++i) values[i] += 2;
  const id = await recorded(values, {device: 'spikes', id: 'spikes', trim_start_s: 10});
  const page = await open(browser, daemon, `/recordings/${id}`);
  const signal = panel(page, 'Signal');
  const apart = signal.locator('.quality-note', {hasText: '3 values apart from the rest'});
  await apart.waitFor();
  const described = await signal.locator('svg[tabindex]').getAttribute('aria-label');
  assert.match(described, /marked:.*values apart from the rest, a jump of the mean/);
  await signal.locator('.quality-note', {hasText: /the mean jumps by (1\.9|2\.0)/}).waitFor();
  await apart.getByRole('button', {name: '90 s'}).click();
  await page.waitForURL(url => Number(url.searchParams.get('t0')) < 90 && Number(url.searchParams.get('t1')) > 90);
  await signal.getByText(/\d+ samples,/).waitFor();
  assert.equal(await signal.locator('svg[tabindex] path[stroke="var(--robust)"]').count(), 1, 'the one that is in view');
  await closed(page);
});

test('runs against one baseline are drawn with intervals and margins, under the device’s name', async () => {
  const ids = [];
  for (const [seed, firmware, level] of [[71, '1.0', 0.1], [72, '1.1', 0.1], [73, '1.2', 0.17]]) ids.push(await recorded(noise(12000, seed, level), {device: 'gate-07', id: `gate-${firmware}`, labels: `firmware=${firmware}`, session: firmware}));
  const jobs = [];
  for (const firmware of ['1.1', '1.2']) {
    const job = await daemon.json('/v1/jobs', {kind: 'regress', inputs: {device: 'gate-07', baseline: {labels: {firmware: '1.0'}}, candidate: {labels: {firmware}}}});
    assert.equal((await daemon.finished(job.id)).state, 'succeeded');
    jobs.push(job.id);
  }
  const {items} = await daemon.json('/v1/regressions?sort=-created_at&parameter=white_noise.N');
  const [worse, same] = items;
  assert.equal(worse.device_name, 'gate-07');
  assert.ok(worse.parameters[0].ci[0] > worse.parameters[0].margin && same.parameters[0].ci[0] < same.parameters[0].margin, JSON.stringify(items.map(run => run.parameters)));
  assert.equal((await daemon.json('/v1/regressions')).items[0].parameters, undefined, 'not asked for');

  const page = await open(browser, daemon, '/regressions');
  await page.getByRole('rowheader', {name: 'gate-07 against firmware=1.0'}).waitFor();
  const figure = panel(page, 'gate-07 against firmware=1.0');
  const svg = figure.locator('svg[tabindex]');
  await svg.waitFor();
  assert.equal(await svg.locator('rect[fill="var(--surface)"]').count(), 2, 'a square for the run that fails, and one in the key');
  await figure.getByRole('button', {name: 'Table'}).click();
  const rows = await figure.locator('.table-view tbody tr').allInnerTexts();
  assert.equal(rows.length, 2, rows.join(' | '));
  await page.getByLabel('parameter').selectOption('white_noise.N');
  assert.ok(!page.url().includes('dev_'));

  // The page of a run leads on: to a pipeline, to a merge request, and to a new baseline with a reason.
  await page.goto(`${daemon.address}/regressions/${jobs[1]}`);
  // The runs so far of the parameter, with this one among them.
  await panel(page, 'White noise N, the runs against firmware=1.0').locator('svg[tabindex] [data-mark], svg[tabindex] circle').first().waitFor();
  // Both arms over each other, above their ratio: a point of the candidate for each averaging time, and the baseline's line.
  const arms = panel(page, 'Allan deviation, gyroscope z').locator('svg[tabindex]');
  await arms.waitFor();
  const scales = (await daemon.json(`/v1/regressions/${jobs[1]}`)).units[0].tests.filter(each => each.kind === 'scale');
  const [csv] = await Promise.all([page.waitForEvent('download'), panel(page, 'Allan deviation, gyroscope z').getByRole('button', {name: 'CSV'}).click()]);
  const lines = readFileSync(await csv.path(), 'utf8').trim().split('\n').map(line => line.split(/,(?=(?:[^"]*"[^"]*")*[^"]*$)/));
  const column = name => lines[0].findIndex(each => each.includes(name) && each.includes('deg/h'));
  for (const [i, scale] of scales.entries()) for (const arm of ['candidate', 'baseline']) assert.equal(Number(lines[i + 1][column(arm)]), scale[arm].value, `${arm} at ${scale.tau_s} s of ${lines[0]}`);
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('link', {name: 'JUnit'}).click()]);
  assert.equal(download.suggestedFilename(), `${jobs[1]}.xml`);
  await page.getByRole('button', {name: 'Markdown'}).click();
  await page.getByText('The Markdown is copied.').waitFor();
  assert.match(await page.evaluate(() => navigator.clipboard.readText()), /^\*\*FAIL\*\*/);
  await page.getByRole('link', {name: 'Compare'}).waitFor();
  await page.getByRole('button', {name: 'Accept as new baseline'}).click();
  const dialog = page.getByRole('dialog', {name: 'Accept as new baseline'});
  await dialog.getByLabel('Reason').fill('the filter was widened');
  await dialog.getByRole('button', {name: 'Accept', exact: true}).click();
  await page.getByText('firmware=1.2 is the baseline of gate-07 now.').waitFor();
  const [anchor] = (await daemon.json('/v1/regression-anchors?device=gate-07&sort=-created_at')).items;
  assert.deepEqual([anchor.label, anchor.reason], ['firmware=1.2', 'the filter was widened']);
  await closed(page);
});

test('rows are 6 px higher where comfortable ones were chosen, after a reload too', async () => {
  const page = await open(browser, daemon, '/devices');
  const height = async () => (await page.locator('tbody tr').first().boundingBox()).height;
  await page.locator('tbody tr').first().waitFor();
  const compact = await height();
  await page.getByRole('button', {name: 'Settings'}).click();
  await page.getByRole('dialog', {name: 'Keys and settings'}).getByRole('button', {name: 'Comfortable'}).click();
  await page.keyboard.press('Escape');
  assert.equal(await height(), compact + 6);
  await page.reload();
  await page.locator('tbody tr').first().waitFor();
  assert.equal(await height(), compact + 6);
  await closed(page);
});

test('an outage evaluation shows what its runs say while they go on', {timeout: 300000}, async () => {
  const made = await daemon.json('/v1/outage-evaluations', {scenario: 'paper', runs: 400});
  const page = await open(browser, daemon, `/outages/${made.id}`, {absent: [/outage-evaluations/]});
  const soFar = panel(page, 'Horizontal error so far');
  await soFar.locator('svg circle').first().waitFor({timeout: 240000});
  const running = await daemon.json(`/v1/outage-evaluations/${made.id}`);
  assert.equal(await soFar.locator('svg circle').count(), running.partial.filters.length);
  for (const {error_m: error} of running.partial.filters) assert.ok(error.ci95[0] < error.value && error.value < error.ci95[1], JSON.stringify(error));
  await page.getByText(/Running: what \d+ runs of 400 say\./).waitFor();
  // A reading that is refused meanwhile says so above what is known, which stays.
  await page.route('**/v1/outage-evaluations/*', route => route.fulfill({status: 422, contentType: 'application/problem+json', body: JSON.stringify({type: '/problems/busy', title: 'Busy', status: 422, detail: 'The daemon is busy.', retryable: true})}));
  await daemon.json(`/v1/jobs/${made.id}/cancel`, {});
  const refusal = page.getByRole('alert').filter({hasText: 'The daemon is busy.'});
  await refusal.waitFor();
  assert.equal(await soFar.locator('svg circle').count(), running.partial.filters.length);
  await page.unroute('**/v1/outage-evaluations/*');
  await refusal.getByRole('button', {name: 'Try again'}).click();
  await refusal.waitFor({state: 'detached'});
  await page.getByText('The job was cancelled; there is no result.').waitFor();
  await closed(page);
});
