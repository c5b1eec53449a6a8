// What a lab has beside recordings of single devices: a line of devices of one model, a drive with fixes, a receiver of webhooks.
// The recordings are simulated, those of the line by the daemon; every result that a page shows is the daemon's own.
import {createServer} from 'node:http';
import {normal} from './world.mjs';

const MODEL = 'L3G4200D';  // a gyroscope whose stated noise is that of the sample
const MODELS = ['WN', 'WN+GM', 'WN+RW'];
// How much noisier each unit is than the sample. The last is not of the line.
const LEVELS = {'line-01': 1, 'line-02': 1.06, 'line-03': 0.95, 'line-04': 1.02, 'line-05': 0.9, 'line-06': 1.1, 'line-07': 0.98, 'line-08': 2.6};

// The recording that the daemon simulates, every value times `level`.
async function scaledSample(daemon, seed, level) {
  const text = await (await fetch(`${daemon.address}/v1/samples/iphone5s-z?seed=${seed}&condition=static`)).text();
  return text.split('\n').map(line => line !== '' && Number.isFinite(Number(line)) ? String(Number(line) * level) : line).join('\n');
}

// Eight devices of one model that a data sheet describes, each with one characterised recording at rest.
export async function fillLine(daemon) {
  const recordings = [];
  let seed = 40;
  for (const [name, level] of Object.entries(LEVELS)) {
    await daemon.json('/v1/devices', {name, model: MODEL});
    recordings.push((await daemon.upload(await scaledSample(daemon, seed++, level), {device: name, condition: 'static', rate_hz: 100, id: `rest-${name}`})).id);
  }
  const jobs = await Promise.all(recordings.map(recording => daemon.json('/v1/jobs', {kind: 'characterise', inputs: {recordings: [recording]}, parameters: {models: MODELS}})));
  for (const job of jobs) await daemon.finished(job.id);
  return {model: MODEL, devices: Object.keys(LEVELS)};
}

const READINGS = ['t', 'gx', 'gy', 'gz', 'ax', 'ay', 'az'];
const FIXES = ['t', 'lat', 'lon', 'height', 'vn', 've', 'vd'];
const axes = (names, quantity, of, unit) => Object.fromEntries(names.map((name, i) => [name, {quantity, axis: of[i], unit}]));
const COLUMNS = {
  imu: {...axes(['gx', 'gy', 'gz'], 'angular_rate', 'xyz', 'rad/s'), ...axes(['ax', 'ay', 'az'], 'specific_force', 'xyz', 'm/s^2')},
  gnss: {lat: {quantity: 'gnss_position', axis: 'lat', unit: 'deg'}, lon: {quantity: 'gnss_position', axis: 'lon', unit: 'deg'}, height: {quantity: 'gnss_position', axis: 'height', unit: 'm'},
         ...axes(['vn', 've', 'vd'], 'gnss_velocity', ['north', 'east', 'down'], 'm/s')},
};
const roles = columns => ['t=time::s', ...Object.entries(columns).map(([name, role]) => `${name}=${role.quantity}:${role.axis}:${role.unit}`)].join(',');

const RADIUS_M = 6366000;
const LATITUDE = 48;
const READINGS_HZ = 20;
const degrees = radians => radians * 180 / Math.PI;

// A car from rest once round a town along bends, readings at 20 Hz and fixes at 1 Hz. `late_s` is by how much the fixes' velocities are
// stamped too late, which an explanation should find.
function driveFiles(seconds, seed, late_s) {
  const random = normal(seed);
  const readings = [READINGS.join(',')];
  const fixes = [FIXES.join(',')];
  const step = 1 / READINGS_HZ;
  const past = [];
  let speed = 0, heading = 0.3, north = 0, east = 0;
  for (let i = 1; i <= seconds * READINGS_HZ; ++i) {
    const time = i * step;
    const acceleration = time < 10 ? 0 : time < 20 ? 1 : 0.9 * Math.sin(0.35 * (time - 20));
    const rate = time < 30 ? 0 : 0.011 + 0.1 * Math.sin(0.11 * (time - 30));
    speed += step * acceleration;
    heading += step * rate;
    north += step * speed * Math.cos(heading);
    east += step * speed * Math.sin(heading);
    past.push([speed * Math.cos(heading), speed * Math.sin(heading)]);
    readings.push([time.toFixed(3), ...[0, 0, rate].map(x => (x + 1e-3 * random()).toFixed(7)), ...[acceleration, speed * rate, -9.81].map(x => (x + 0.01 * random()).toFixed(6))].join(','));
    if (i % READINGS_HZ !== 0) continue;
    const then = past[Math.max(0, past.length - 1 - Math.round(late_s * READINGS_HZ))];
    const blurred = [north + random(), east + random()];
    fixes.push([time.toFixed(3), (LATITUDE + degrees(blurred[0] / RADIUS_M)).toFixed(9), (9 + degrees(blurred[1] / (RADIUS_M * Math.cos(LATITUDE * Math.PI / 180)))).toFixed(9), (300 + 2 * random()).toFixed(3),
      ...[...then, 0].map(x => (x + 0.05 * random()).toFixed(4))].join(','));
  }
  return {imu: readings.join('\n') + '\n', gnss: fixes.join('\n') + '\n'};
}

const white = (value, unit) => ({processes: [{process: 'white_noise', params: {N: {value, unit}}}]});

// A drive, and what each of the three questions answers: {drive, run, simulate, explain} as ids.
export async function fillDrive(daemon) {
  const files = driveFiles(600, 5, 0.4);
  const ids = {};
  for (const source of ['imu', 'gnss']) ids[source] = (await daemon.upload(files[source], {device: 'car-01', condition: 'drive', id: `town-${source}`, columns: roles(COLUMNS[source])})).id;
  const time = {column: 't', unit: 's', scale: 'gps'};
  const drive = await daemon.json('/v1/drives', {
    id: 'town', vehicle: 'road', imu: {recording: ids.imu, columns: COLUMNS.imu, time},
    gnss: {recording: ids.gnss, columns: COLUMNS.gnss, time, position_sd_m: [1, 1, 2], velocity_sd_m_s: [0.05, 0.05, 0.05]},
    model: {gyroscope: {...white(1, 'deg/sqrt(h)'), constant_bias_sd_deg_s: 0.1}, accelerometer: {...white(0.2, 'm/s/sqrt(h)'), constant_bias_sd_mg: 5}},
    outages: {duration_s: [5, 10, 20, 30], every_s: [40, 40, 50, 60], phases: 4, settle_s: 30},
  });
  const asked = {drive: drive.id};
  for (const [question, more] of [['run', {}], ['simulate', {runs: 4}], ['explain', {runs: 2}]]) asked[question] = (await daemon.json('/v1/drive-evaluations', {drive: drive.id, question, ...more})).id;
  for (const question of ['run', 'simulate', 'explain']) await daemon.finished(asked[question]);
  return asked;
}

// A receiver on this machine that answers `status` and keeps its messages; the daemon must have been started with --webhook-allow 127.0.0.1.
export async function receiver(status) {
  const messages = [];
  const server = createServer(async (request, answer) => {
    let body = '';
    for await (const piece of request) body += piece;
    messages.push({headers: request.headers, body});
    answer.writeHead(status);
    answer.end();
  });
  await new Promise(resolve => server.listen(0, '127.0.0.1', resolve));
  server.unref();
  return {url: `http://127.0.0.1:${server.address().port}/hook`, messages, close: () => { server.closeAllConnections(); server.close(); }};
}

// Waits until nothing that a webhook was told waits any more.
export async function told(daemon, webhook, patience_ms = 60000) {
  for (const until = Date.now() + patience_ms; Date.now() < until;) {
    const {items} = await daemon.json(`/v1/webhooks/${webhook}/deliveries`);
    if (items.length > 0 && items.every(delivery => delivery.state !== 'waiting')) return items;
    await new Promise(resolve => setTimeout(resolve, 50));
  }
  throw new Error(`the webhook ${webhook} still waits`);
}
