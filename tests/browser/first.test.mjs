// What a page asks for before anything is painted, and what the first page weighs (brief, section 11).
import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {Daemon, csv, launch, open} from './world.mjs';

const FIRST_PAGE_KIB = 45;

let browser;
let daemon;
before(async () => { browser = await launch(); daemon = await Daemon.start(); });
after(async () => { await browser?.close(); await daemon?.end(); });

// Scripts and styles of a page in the order in which they were asked for, as they came over the wire.
async function asked(page, path, selector) {
  const session = await page.context().newCDPSession(page);
  await session.send('Network.enable');
  const found = new Map();
  session.on('Network.requestWillBeSent', event => { if (/\.(js|css)$/.test(event.request.url)) found.set(event.requestId, {path: new URL(event.request.url).pathname, by: event.initiator.type}); });
  session.on('Network.loadingFinished', event => { const one = found.get(event.requestId); if (one) one.bytes = event.encodedDataLength; });
  await page.goto(daemon.address + path);
  await page.locator(selector).first().waitFor();
  return [...found.values()];
}

test('the document, one style and one script come before the first paint, the Lab after', async () => {
  const made = await daemon.upload(csv(4000, 5), {device: 'first', condition: 'static', rate_hz: 100});
  await daemon.characterise(made.id);
  const page = await open(browser, daemon, '/healthz', {absent: [/favicon/]});  // so that the page that is measured is not kept already
  const files = await asked(page, '/', 'table tbody tr');
  assert.equal(files.filter(file => file.by === 'parser').length, 2, `asked for by the document: ${JSON.stringify(files)}`);
  assert.ok(files.length <= 3, `the Lab needs no more than its own file beside them: ${files.map(file => file.path).join(' ')}`);
  const kib = files.reduce((sum, file) => sum + file.bytes, 0) / 1024;
  assert.ok(kib < FIRST_PAGE_KIB, `shell and Lab are ${kib.toFixed(1)} KiB`);
  assert.deepEqual(page.loud, []);
  await page.context().close();
});

test('an empty lab offers its drop zone, whose file comes when it is needed', async () => {
  const empty = await Daemon.start();
  try {
    const page = await open(browser, empty, '/');
    await page.getByRole('button', {name: 'Try the sample'}).waitFor();
    assert.deepEqual(page.loud, []);
    await page.context().close();
  } finally {
    await empty.end();
  }
});

test('a file that is dropped on any page is for the upload', async () => {
  await daemon.upload(csv(600, 6), {device: 'dropped-on', condition: 'static', rate_hz: 100});
  const page = await open(browser, daemon, '/devices/dropped-on');
  await page.getByRole('heading', {level: 1, name: 'dropped-on'}).waitFor();
  const left = await page.evaluate(text => {
    const data = new DataTransfer();
    data.items.add(new File([text], 'bench.csv', {type: 'text/csv'}));
    const drop = new DragEvent('drop', {dataTransfer: data, bubbles: true, cancelable: true});
    document.querySelector('h1').dispatchEvent(drop);
    return !drop.defaultPrevented;
  }, csv(600, 7));
  assert.equal(left, false, 'the browser does not leave the lab for the file');
  await page.waitForURL(/\/upload$/);
  await page.getByText('bench.csv').first().waitFor();
  assert.deepEqual(page.loud, []);
  await page.context().close();
});
