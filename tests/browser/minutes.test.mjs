// Somebody who has never seen driftlab: from an address to the file of a figure worth printing, by clicks alone, with the clock running.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {createServer} from 'node:net';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {after, before, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {Daemon, PATIENCE_MS, launch, open} from './world.mjs';

const repository = join(dirname(fileURLToPath(import.meta.url)), '../..');
const TWO_MINUTES_MS = 120000;

let browser;
before(async () => { browser = await launch(); });
after(async () => { await browser?.close(); });

const freePort = () => new Promise(resolve => { const server = createServer(); server.listen(0, '127.0.0.1', () => { const {port} = server.address(); server.close(() => resolve(port)); }); });

// quickstart.sh as it is typed, on the programs that are built: {address, end}.
async function quickstart() {
  const data = mkdtempSync(join(tmpdir(), 'driftlab-quickstart-'));
  const environment = Object.fromEntries(Object.entries(process.env).filter(([name]) => !name.startsWith('DRIFTLAB')));
  const child = spawn(join(repository, 'deploy/quickstart.sh'), ['--bin', dirname(process.env.DRIFTLABD), '--data', data, '--port', String(await freePort())], {env: environment, stdio: ['ignore', 'pipe', 'pipe']});
  let said = '';
  const address = await new Promise((resolve, reject) => {
    child.stdout.on('data', piece => {
      said += piece;
      const found = /serves at (http:\S+)/.exec(said);
      if (found) resolve(found[1]);
    });
    child.stderr.on('data', piece => { said += piece; });
    child.on('exit', code => reject(new Error(`quickstart ended with ${code}: ${said.slice(-400)}`)));
  });
  const end = async () => {
    child.removeAllListeners('exit');
    const gone = new Promise(resolve => child.once('exit', resolve));
    child.kill('SIGTERM');
    await gone;
    rmSync(data, {recursive: true, force: true});
  };
  return {address, end};
}

// A click on what stands there, and no other way to go anywhere; what each step took is told where the whole is too slow.
class Visitor {
  constructor(page) {
    this.page = page;
    this.began = Date.now();
    this.steps = [];
  }
  async click(what, where) {
    await where.first().waitFor({state: 'visible', timeout: PATIENCE_MS});
    await where.first().click();
    this.steps.push(`${what}: ${((Date.now() - this.began) / 1000).toFixed(1)} s`);
  }
  // The file of the first figure of a deviation on the page.
  async saves() {
    const button = this.page.locator('section.panel', {has: this.page.getByRole('heading', {name: /^Allan deviation/})}).getByRole('button', {name: 'SVG', exact: true});
    await button.first().waitFor();
    const [download] = await Promise.all([this.page.waitForEvent('download'), this.click('saved', button)]);
    const took = Date.now() - this.began;
    const svg = readFileSync(await download.path(), 'utf8');
    assert.ok(took < TWO_MINUTES_MS, `it took ${took / 1000} s: ${this.steps.join(', ')}`);
    console.log(`# ${this.steps.join(', ')}`);
    return svg;
  }
}

function assertWorthPrinting(svg) {
  assert.match(svg, /^<svg [^>]*xmlns="http:\/\/www\.w3\.org\/2000\/svg"/);
  assert.match(svg, /<title>Allan deviation/);
  assert.match(svg, /Allan deviation, deg\/h/, 'the axis says its unit');
  assert.match(svg, /averaging time τ, s/);
  assert.match(svg, />driftlab \d+\.\d+\.\d+, /, 'the source says which version made it');
  assert.ok(svg.match(/<circle /g).length >= 10, 'measured points');
  assert.doesNotMatch(svg, /var\(--|<script|data-cursor/);
}

test('from the address that quickstart prints to a saved figure in two minutes, by clicks', {timeout: 300000}, async () => {
  const lab = await quickstart();
  try {
    const page = await open(browser, {address: lab.address}, '/');
    const visitor = new Visitor(page);
    await visitor.click('the device of the sample', page.getByRole('link', {name: 'iphone5s-simulated', exact: true}));
    assertWorthPrinting(await visitor.saves());
    // The sample again, from where files go: what is stored already is no obstacle.
    await visitor.click('Upload', page.getByRole('link', {name: 'Upload', exact: true}));
    await visitor.click('the sample', page.getByRole('button', {name: 'Try the sample'}));
    await page.waitForURL(/\/devices\/iphone5s-simulated/);
    assert.deepEqual(page.loud, []);
    await page.context().close();
  } finally {
    await lab.end();
  }
});

test('from an empty lab to a saved figure in two minutes, by clicks', {timeout: 300000}, async () => {
  const daemon = await Daemon.start();
  try {
    const page = await open(browser, daemon, '/');
    const visitor = new Visitor(page);
    await visitor.click('the sample', page.getByRole('button', {name: 'Try the sample'}));
    await page.waitForURL(/\/devices\/iphone5s-simulated/);
    const there = Date.now();
    const [bar, figure] = [page.locator('[role=progressbar]').first(), page.getByText('The white-noise density N is 1.03').first()];
    const live = await Promise.race([bar.waitFor().then(() => true, () => false), figure.waitFor().then(() => false)]);  // the real job, live
    if (!live) {  // unless it had ended before the page was there
      const [{finished_at: ended}] = (await daemon.json('/v1/jobs?kind=characterise')).items;
      assert.ok(Date.parse(ended) < there + 1000, `the job ended at ${ended} and was never seen at work`);
    }
    assertWorthPrinting(await visitor.saves());
    await page.getByText('The white-noise density N is 1.03').first().waitFor();
    const rows = page.locator('table.pt tbody tr', {hasText: /static|9 deg\/s/});
    while (await rows.count() < 2) await page.waitForTimeout(100);  // the second condition comes without a click
    await page.getByText(/still being fitted/).waitFor({state: 'detached'});
    assert.deepEqual(page.loud, []);
    await page.context().close();
  } finally {
    await daemon.end();
  }
});
