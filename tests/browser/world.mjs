// A daemon on a directory of its own, Debian's Chromium before it, and what every page must keep to.
import assert from 'node:assert/strict';
import {execFileSync, spawn} from 'node:child_process';
import {createHash} from 'node:crypto';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';

const repository = join(dirname(fileURLToPath(import.meta.url)), '../..');
const require = createRequire(join(repository, 'clients/dashboard/package.json'));
const {chromium} = require('playwright-core');
const axe = readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');

export const PATIENCE_MS = 60000;

// Where a daemon keeps its rows: beside its files, or in a schema of the server that on_postgres.py names.
function store(data) {
  const server = process.env.DRIFTLAB_TEST_POSTGRES;
  if (!server) return [];
  const schema = 't' + createHash('sha256').update(data).digest('hex').slice(0, 20);
  const statement = `SET client_min_messages = warning; CREATE SCHEMA IF NOT EXISTS ${schema}`;
  execFileSync('psql', [`--host=${server}`, '--username=driftlab', '--dbname=postgres', '--no-psqlrc', '--quiet', `--command=${statement}`]);
  return ['--store', `postgresql:///postgres?user=driftlab&host=${server}&options=-csearch_path%3D${schema}`];
}

export class Daemon {
  static async start(data = mkdtempSync(join(tmpdir(), 'driftlab-browser-')), port = 0, more = []) {
    const daemon = new Daemon();
    daemon.data = data;
    const environment = Object.fromEntries(Object.entries(process.env).filter(([name]) => !name.startsWith('DRIFTLAB_')));
    daemon.process = spawn(process.env.DRIFTLABD, ['--data', data, '--listen', `127.0.0.1:${port}`, ...store(data), ...more], {stdio: ['ignore', 'ignore', 'pipe'], env: environment});
    daemon.port = await new Promise((resolve, reject) => {
      let text = '';
      daemon.process.stderr.on('data', piece => {
        text += piece;
        const found = /"port": ?(\d+)/.exec(text);
        if (found) resolve(Number(found[1]));
      });
      daemon.process.on('exit', code => reject(new Error(`the daemon ended with ${code}: ${text.slice(-400)}`)));
    });
    daemon.address = `http://127.0.0.1:${daemon.port}`;
    return daemon;
  }

  async stop(signal = 'SIGTERM') {
    if (this.process.exitCode !== null) return;
    const ended = new Promise(resolve => this.process.once('exit', resolve));
    this.process.kill(signal);
    await ended;
  }

  async end() {
    await this.stop('SIGKILL');
    rmSync(this.data, {recursive: true, force: true});
  }

  async json(path, body, headers = {}) {
    const answer = await fetch(this.address + path, body === undefined ? {headers} : {method: 'POST', body: JSON.stringify(body), headers: {'Content-Type': 'application/json', ...headers}});
    return answer.json();
  }

  async upload(text, query) {
    const answer = await fetch(`${this.address}/v1/recordings?${new URLSearchParams(query)}`, {method: 'POST', body: text, headers: {'Content-Type': 'application/octet-stream'}});
    return answer.json();
  }

  async finished(job) {
    for (const until = Date.now() + PATIENCE_MS; Date.now() < until;) {
      const document = await this.json(`/v1/jobs/${job}`, undefined, {Prefer: 'wait=20'});
      if (document.finished_at) return document;
    }
    throw new Error(`the job ${job} does not end`);
  }

  async characterise(...recordings) {
    const job = await this.json('/v1/jobs', {kind: 'characterise', inputs: {recordings}, parameters: {models: ['WN', 'WN+GM', 'WN+RW']}});
    return this.finished(job.id);
  }
}

// Normal numbers that are the same each time: a linear congruential generator, twelve uniforms a value.
export function normal(seed = 1) {
  let state = seed;
  const uniform = () => { state = (Math.imul(state, 1664525) + 1013904223) >>> 0; return state / 2 ** 32; };
  return () => { let sum = -6; for (let i = 0; i < 12; ++i) sum += uniform(); return sum; };
}

export function noise(samples, seed = 1, sigma = 0.1) {
  const random = normal(seed);
  return Array.from({length: samples}, () => random() * sigma);
}

export const csv = (samples, seed = 1, heading = 'gz [deg/s]') => `${heading}\n${noise(samples, seed).map(x => x.toFixed(6)).join('\n')}\n`;

export const launch = () => chromium.launch({executablePath: process.env.DRIFTLAB_CHROMIUM ?? '/usr/bin/chromium', args: ['--no-sandbox', '--disable-dev-shm-usage']});

// A recording is asked for its result before anybody knows whether it has one.
const ASKED_IN_DOUBT = [/\/v1\/recordings\/[^/]+\/characterisation/];

// A tab whose console errors, failed scripts, policy violations and refused requests are kept in `loud`, which must be empty in the end.
// `absent`: addresses that may hold nothing, or that the test lets the daemon refuse; `page.away`: the daemon is stopped on purpose.
export async function open(browser, daemon, path, {absent = [], ...options} = {}) {
  const context = await browser.newContext({viewport: {width: 1440, height: 900}, acceptDownloads: true, permissions: ['clipboard-read', 'clipboard-write'], ...options});
  const page = await context.newPage();
  page.setDefaultTimeout(PATIENCE_MS);
  page.loud = [];
  page.on('pageerror', error => page.loud.push(String(error)));
  page.absent = [...ASKED_IN_DOUBT, ...absent];
  page.on('console', message => {
    const {url} = message.location();
    const text = message.text();
    if (message.type() !== 'error' || (page.away && /ERR_|Failed to load resource/.test(text))) return;
    if (/status of (400|404|422)/.test(text) && page.absent.some(pattern => pattern.test(url))) return;
    page.loud.push(`${text} ${url}`);
  });
  await page.goto(daemon.address + path);
  return page;
}

// Nothing was loud, and the tab goes.
export async function closed(page) {
  assert.deepEqual(page.loud, []);
  await page.context().close();
}

// A characterised recording of a gyroscope z at 100 Hz [deg/s]: its id.
export async function characterised(daemon, values, about) {
  const text = `gz [deg/s]\n${values.map(x => x.toFixed(6)).join('\n')}\n`;
  const made = await daemon.upload(text, {condition: 'static', rate_hz: 100, columns: 'gz [deg/s]=angular_rate:z:deg/s', ...about});
  assert.equal((await daemon.characterise(made.id)).state, 'succeeded');
  return made.id;
}

// What axe finds against WCAG 2.2 AA, as lines.
export async function accessibilityFaults(page, runOnly = ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice']) {
  await page.evaluate(axe);
  const result = await page.evaluate(only => window.axe.run(document, {runOnly: only}), runOnly);
  return result.violations.map(fault => `${fault.id}: ${fault.nodes.slice(0, 3).map(node => node.target.join(' ')).join(' | ')}`);
}
