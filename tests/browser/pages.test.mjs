// Every page: nothing for axe to find in either theme, nothing in the console, nothing wider than a phone. With
// $DRIFTLAB_SCREENS each is also pictured at 390, 1440 and 2560 px, light and dark, for a person to look at.
import assert from 'node:assert/strict';
import {mkdirSync, readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {fillDrive, fillLine, receiver, told} from './lab.mjs';
import {Daemon, accessibilityFaults, csv, launch, open} from './world.mjs';

let browser;
let daemon;
let paths;

before(async () => {
  browser = await launch();
  daemon = await Daemon.start(undefined, undefined, ['--webhook-allow', '127.0.0.1']);
  const ids = [];
  for (const [condition, seed] of [['static', 1], ['static', 2], ['constant_rate:z:9:deg/s', 3]]) {
    const sample = await (await fetch(`${daemon.address}/v1/samples/iphone5s-z?seed=${seed}&condition=${encodeURIComponent(condition)}`)).text();
    ids.push((await daemon.upload(sample, {device: 'phone-07', condition, rate_hz: 100, id: `run-${seed}`})).id);
  }
  await daemon.characterise(...ids);
  const study = await daemon.json('/v1/studies', {device: {id: 'phone-07'}, recordings: ids.slice(0, 2).map(recording => ({recording}))});
  const investigate = await daemon.json('/v1/jobs', {kind: 'investigate', inputs: {study: study.id}});
  const outages = await daemon.json('/v1/outage-evaluations', {scenario: 'paper', runs: 2});
  const waiting = await daemon.upload(csv(4000, 9), {device: 'new-01', condition: 'static', rate_hz: 100});
  await daemon.finished(investigate.id);
  await daemon.finished(outages.id);
  const other = await daemon.upload(await (await fetch(`${daemon.address}/v1/samples/iphone5s-z?seed=8&condition=static`)).text(), {device: 'phone-07', condition: 'static', rate_hz: 100, id: 'run-8'});
  await daemon.characterise(other.id);
  const regress = await daemon.json('/v1/jobs', {kind: 'regress', inputs: {device: 'phone-07', baseline: {recordings: [{recording: ids[0]}]}, candidate: {recordings: [{recording: ids[1]}]}}});
  await daemon.finished(regress.id);
  const [listens, refuses] = [await receiver(204), await receiver(410)];
  const webhook = await daemon.json('/v1/webhooks', {url: listens.url, description: 'firmware pipeline', events: ['regression.ended', 'job.ended']});
  const refused = await daemon.json('/v1/webhooks', {url: refuses.url, description: 'old wiki'});
  const line = await fillLine(daemon);
  const drive = await fillDrive(daemon);
  await told(daemon, webhook.id);
  await told(daemon, refused.id);
  listens.close();
  refuses.close();
  const [investigation] = (await daemon.json('/v1/investigations')).items;
  const [model] = (await daemon.json('/v1/models')).items;
  paths = {
    lab: '/', devices: '/devices', device: '/devices/phone-07', 'device-new': '/devices/new-01', recording: `/recordings/${ids[0]}`, 'recording-new': `/recordings/${waiting.id}`,
    compare: `/compare?with=${ids[0]},${ids[2]}`, 'compare-empty': '/compare', investigations: '/investigations?device=phone-07', investigation: `/investigations/${investigation.id}`,
    outages: '/outages', outage: `/outages/${outages.id}`, jobs: '/jobs', job: `/jobs/${investigate.id}`, upload: '/upload', docs: '/docs', manual: '/docs/units', problem: '/problems/ragged-row',
    model: `/models/${model.id}`, regressions: '/regressions', regression: `/regressions/${regress.id}`, record: '/record',
    populations: '/populations', population: `/populations/${line.model}`, 'device-line': `/devices/${line.devices[0]}`, 'data-sheets': '/data-sheets', 'data-sheet': `/data-sheets/${line.model}`,
    webhooks: '/webhooks', webhook: `/webhooks/${webhook.id}`, 'webhook-refused': `/webhooks/${refused.id}`, drives: '/drives', drive: `/drives/${drive.drive}`,
    'drive-run': `/drive-evaluations/${drive.run}`, 'drive-simulate': `/drive-evaluations/${drive.simulate}`, 'drive-explain': `/drive-evaluations/${drive.explain}`, absent: '/devices/nobody/nothing',
  };
});
after(async () => { await browser?.close(); await daemon?.end(); });

const settled = async page => {
  await page.locator('h1').first().waitFor();
  // Nothing is being read, for a while: what was read may show a part that reads more. The stream of events never ends.
  await page.waitForFunction(() => {
    const now = performance.now();
    if (document.querySelector('[aria-busy=true]')) window.calmSince = undefined;
    else window.calmSince ??= now;
    return window.calmSince !== undefined && now - window.calmSince > 300;
  }, undefined, {timeout: 20000});
};

for (const colorScheme of ['light', 'dark']) {
  test(`axe finds nothing on any page, ${colorScheme}`, async () => {
    const page = await open(browser, daemon, '/', {colorScheme});
    const faults = [];
    for (const [name, path] of Object.entries(paths)) {
      await page.goto(daemon.address + path, {waitUntil: 'domcontentloaded'});
      await settled(page);
      faults.push(...(await accessibilityFaults(page)).map(fault => `${name}: ${fault}`));
    }
    assert.deepEqual(faults, []);
    assert.deepEqual(page.loud, []);
    await page.context().close();
  });
}

test('no page is wider than a phone', async () => {
  const page = await open(browser, daemon, '/', {viewport: {width: 390, height: 844}});
  const wide = [];
  for (const [name, path] of Object.entries(paths)) {
    await page.goto(daemon.address + path, {waitUntil: 'domcontentloaded'});
    await settled(page);
    const width = await page.evaluate(() => document.documentElement.scrollWidth);
    if (width > 390) wide.push(`${name}: ${width}`);
  }
  assert.deepEqual(wide, []);
  await page.context().close();
});

test('figures that a page draws itself are saved as files and read as tables', async () => {
  const page = await open(browser, daemon, paths.outage);
  const reader = await browser.newPage();  // no policy of the daemon's keeps it from parsing a document with a style
  for (const [title, name, marks] of [['Drive', 'outage-drive', 'polyline'], ['Outage 1, end', 'outage-1-end', 'ellipse'], ['Horizontal error by filter', 'outage-errors', 'circle'], ['Does the filter know', 'outage-nees', 'circle'], ['Where the gain comes from', 'outage-gain', 'line']]) {
    const panel = page.locator('section.panel', {has: page.getByRole('heading', {name: title})});
    const saved = async button => { const [download] = await Promise.all([page.waitForEvent('download'), panel.getByRole('button', {name: button}).click()]); return [download.suggestedFilename(), readFileSync(await download.path(), 'utf8')]; };
    const [svgName, svg] = await saved('SVG');
    assert.equal(svgName, `${name}.svg`);
    const faults = await reader.evaluate(([text, tag]) => { const parsed = new DOMParser().parseFromString(text, 'image/svg+xml'); return [parsed.querySelector('parsererror')?.textContent ?? '', parsed.querySelectorAll(tag).length, text.includes('var(--')]; }, [svg, marks]);
    assert.equal(faults[0], '', title);
    assert.ok(faults[1] > 0, `${title}: ${marks}`);
    assert.equal(faults[2], false, `${title}: colours are those of the light theme`);
    assert.match(svg, /driftlab, job_\w+, algorithm \d+, seed 1/, title);
    const [, csvText] = await saved('CSV');
    await panel.getByRole('button', {name: 'Table'}).click();
    assert.equal(await panel.locator('.table-view tbody tr').count(), csvText.trim().split('\n').length - 1, title);
  }
  assert.deepEqual(page.loud, []);
  await reader.close();
  await page.context().close();
});

test('a device’s page leads to its comparison and exports its model as the command line does', async () => {
  const page = await open(browser, daemon, paths.device);
  const {items: attention} = await daemon.json('/v1/attention?device=phone-07&limit=500');
  const {items: recordings} = await daemon.json('/v1/recordings?device=phone-07');
  for (const recording of recordings) {
    const about = attention.find(one => one.recording === recording.id);
    const words = await page.locator('.list-of-recordings tr', {hasText: recording.metadata.id}).innerText();
    assert.ok(words.includes(about ? about.verdict : 'fits'), words);
  }
  assert.ok(attention.some(one => one.recording) && recordings.length > attention.filter(one => one.recording).length, 'both kinds are there');
  await page.getByRole('button', {name: 'Export model'}).click();
  const drawer = page.getByRole('dialog');
  await drawer.getByText('gyroscope_noise_density').first().waitFor();
  assert.equal((await drawer.locator('pre').innerText()).trimEnd(), (await (await fetch(`${daemon.address}/v1/exports/kalibr?device=phone-07`, {headers: {Accept: 'text/plain'}})).text()).trimEnd());
  await drawer.getByLabel('Program').selectOption('gazebo');
  await drawer.getByText('<stddev>').first().waitFor();
  assert.deepEqual(await accessibilityFaults(page), []);
  await page.keyboard.press('Escape');
  await page.getByRole('link', {name: 'Compare'}).click();
  await page.waitForURL(/compare\?with=rec_\w+,rec_/);
  assert.deepEqual(page.loud, []);
  await page.context().close();
});

test('a report on paper has verdict, figures, method, seeds and versions, and none of the controls', async () => {
  const page = await open(browser, daemon, '/');
  const most = {device: 2, recording: 1, investigation: 12, outage: 5, regression: 3, population: 4, 'drive-simulate': 5, 'drive-explain': 6};
  for (const [name, pages] of Object.entries(most)) {
    await page.goto(`${daemon.address}${paths[name]}?print=1`, {waitUntil: 'domcontentloaded'});
    await settled(page);
    await page.emulateMedia({media: 'print'});
    // Figures are drawn as wide as they are on paper, not shrunk to it: their text is as large as that around them. The one sheet of a
    // recording is set at four fifths as a whole.
    const shrunk = await page.evaluate(() => [...document.querySelectorAll('main .figure svg')].filter(svg => !svg.closest('.small-multiples') && svg.getBoundingClientRect().width < 0.79 * Number(svg.getAttribute('width'))).length);
    if (name === 'device' || name === 'recording') assert.equal(shrunk, 0, `${name}: figures`);
    const text = await page.locator('main').innerText();
    assert.match(text, /seed|algorithm|version/i, `${name}: method`);
    assert.ok(await page.locator('.method').filter({visible: true}).count() > 0, `${name}: method`);
    assert.equal(await page.locator('.bar, .tools, .actions').filter({visible: true}).count(), 0, name);
    assert.ok(await page.locator('.verdict').isVisible(), name);
    const paper = await page.pdf({format: 'A4'});
    const count = paper.toString('latin1').match(/\/Type\s*\/Page\b/g).length;
    assert.ok(count <= pages, `${name}: ${count} pages`);
    if (process.env.DRIFTLAB_SCREENS) { mkdirSync(process.env.DRIFTLAB_SCREENS, {recursive: true}); writeFileSync(join(process.env.DRIFTLAB_SCREENS, `${name}-report.pdf`), paper); }
    await page.emulateMedia({media: null});
  }
  assert.deepEqual(page.loud, []);
  await page.context().close();
});

test('what was marked as seen stays so in this browser alone, and can be shown again', async () => {
  const page = await open(browser, daemon, '/');
  await settled(page);
  const panel = page.locator('section.panel', {has: page.getByRole('heading', {name: 'Wants a look'})});
  const before = await panel.locator('li').count();
  assert.ok(before > 0);
  await panel.getByRole('button', {name: 'Mark all seen'}).click();
  await panel.getByText('Nothing that was not seen.').waitFor();
  await page.reload({waitUntil: 'domcontentloaded'});
  await settled(page);
  await page.getByText('Nothing new wants a look.').waitFor();
  const other = await open(browser, daemon, '/');
  await other.locator('section.panel li').first().waitFor();
  await panel.getByRole('button', {name: 'Show what was seen'}).click();
  await panel.locator('li').first().waitFor();
  assert.equal(await panel.locator('li').count(), before);
  assert.deepEqual([...page.loud, ...other.loud], []);
  await page.context().close();
  await other.context().close();
});

test('the margin of a regression is drawn at the ratio that is tolerated', async () => {
  // The document states it as a ratio, 1.1 where 10 % are tolerated; the page once drew 2.1 and wrote 110 %.
  const page = await open(browser, daemon, paths.regression);
  await settled(page);
  await page.getByRole('button', {name: 'Table'}).first().click();
  const rows = await page.locator('main table').first().locator('tr').allInnerTexts();
  assert.ok(rows.some(row => /(^|\s)1\.1(0*)?(\s|$)/.test(row)), rows.slice(0, 4).join(' | '));
  assert.ok(!rows.some(row => /(^|\s)2\.1(0*)?(\s|$)/.test(row)), rows.slice(0, 4).join(' | '));
  await page.context().close();
});

test('curl gets what it got, browsers get pages that forbid everything of others', async () => {
  const get = (path, headers = {}) => fetch(daemon.address + path, {headers});
  const html = {Accept: 'text/html,application/xhtml+xml,*/*;q=0.8'};
  assert.match((await get('/docs')).headers.get('content-type'), /application\/json/);
  assert.match((await get('/docs/units')).headers.get('content-type'), /text\/markdown/);
  assert.equal((await get('/devices')).status, 404);
  assert.match((await get('/v1/devices', html)).headers.get('content-type'), /application\/json/);
  const page = await get('/devices', html);
  assert.equal(page.status, 200);
  const policy = page.headers.get('content-security-policy');
  assert.match(policy, /default-src 'none'/);
  assert.doesNotMatch(policy, /unsafe/);
  assert.equal(page.headers.get('cache-control'), 'no-cache');
  const [script] = /\/assets\/main-[\w-]+\.js/.exec(await page.text());
  const asset = await get(script);
  assert.match(asset.headers.get('cache-control'), /immutable/);
  assert.equal(asset.headers.get('content-encoding'), 'gzip');
  assert.equal((await get(script, {'If-None-Match': asset.headers.get('etag')})).status, 304);
  assert.equal((await get('/assets/none.js')).status, 404);
});

if (process.env.DRIFTLAB_SCREENS) {
  test('pictures of every page', async () => {
    mkdirSync(process.env.DRIFTLAB_SCREENS, {recursive: true});
    for (const colorScheme of ['light', 'dark']) {
      for (const width of [390, 1440, 2560]) {
        const page = await open(browser, daemon, '/', {colorScheme, viewport: {width, height: 900}});
        for (const [name, path] of Object.entries(paths)) {
          await page.goto(daemon.address + path, {waitUntil: 'domcontentloaded'});
          await settled(page);
          await page.screenshot({path: join(process.env.DRIFTLAB_SCREENS, `${name}-${width}-${colorScheme}.png`), fullPage: true});
        }
        await page.context().close();
      }
    }
  });
}
