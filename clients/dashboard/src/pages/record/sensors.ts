// The motion sensors of a phone, as far as its browser gives them: rows of time and six values, in rad/s and m/s².

export const COLUMNS = {
  gx: {quantity: 'angular_rate', axis: 'x', unit: 'rad/s'}, gy: {quantity: 'angular_rate', axis: 'y', unit: 'rad/s'}, gz: {quantity: 'angular_rate', axis: 'z', unit: 'rad/s'},
  ax: {quantity: 'specific_force', axis: 'x', unit: 'm/s^2'}, ay: {quantity: 'specific_force', axis: 'y', unit: 'm/s^2'}, az: {quantity: 'specific_force', axis: 'z', unit: 'm/s^2'},
} as const;
export type ColumnName = keyof typeof COLUMNS;
export const NAMES = Object.keys(COLUMNS) as ColumnName[];

export interface Row { time: number; values: number[] }  // seconds since 1970, NaN where a sensor is missing
export interface Sensors { start: (onRow: (row: Row) => void, onFault: (sentence: string) => void) => void; stop: () => void }

interface GenericSensor extends EventTarget { x?: number; y?: number; z?: number; timestamp?: number; start(): void; stop(): void }
type SensorClass = new (options: {frequency: number}) => GenericSensor;
interface SensorWindow { Gyroscope?: SensorClass; Accelerometer?: SensorClass; DeviceMotionEvent?: {requestPermission?: () => Promise<string>} }
const given = window as unknown as SensorWindow;

const FREQUENCY_HZ = 100;
const DEGREE = Math.PI / 180;
const DENIED = 'The browser does not let this page read the sensors. Allow “motion sensors” for this address in the settings of the site (the sign at the left of the address), then reload.';

// Why nothing can be recorded here, in words; null where it may work.
export function whyNot(): string | null {
  if (!window.isSecureContext) return `Sensors need https, and this page came by http. Open https://${window.location.host}/record, or record with an app such as Sensor Logger and drop its file.`;
  if (!given.Gyroscope && !given.DeviceMotionEvent) return 'This browser gives pages no motion sensors. Record with an app such as Sensor Logger or phyphox and drop its file.';
  return null;
}

const absolute = (milliseconds: number): number => (performance.timeOrigin + milliseconds) / 1000;

// Generic Sensor API: a row for each reading of the gyroscope, with the latest of the accelerometer.
function genericSensors(Gyroscope: SensorClass, Accelerometer: SensorClass | undefined): Sensors {
  let stopAll: (() => void)[] = [];
  return {
    start(onRow, onFault) {
      const fault = (event: Event): void => {
        const {error} = event as Event & {error?: DOMException};
        onFault(error?.name === 'NotAllowedError' ? DENIED : `The gyroscope cannot be read: ${error?.message ?? 'no reason given'}.`);
      };
      const gyroscope = new Gyroscope({frequency: FREQUENCY_HZ});
      const accelerometer = Accelerometer ? new Accelerometer({frequency: FREQUENCY_HZ}) : null;
      const read = (): void => {
        const force = accelerometer && accelerometer.timestamp ? [accelerometer.x, accelerometer.y, accelerometer.z] : [NaN, NaN, NaN];
        onRow({time: absolute(gyroscope.timestamp ?? performance.now()), values: [gyroscope.x, gyroscope.y, gyroscope.z, ...force].map(value => value ?? NaN)});
      };
      gyroscope.addEventListener('reading', read);
      gyroscope.addEventListener('error', fault);
      gyroscope.start();
      accelerometer?.start();
      stopAll = [() => { gyroscope.removeEventListener('reading', read); gyroscope.stop(); }, () => accelerometer?.stop()];
    },
    stop() { for (const stop of stopAll) stop(); stopAll = []; },
  };
}

// Device orientation events: Safari, Firefox. Rates about z, x, y in degrees.
function motionSensors(): Sensors {
  let listener: ((event: DeviceMotionEvent) => void) | null = null;
  return {
    start(onRow, onFault) {
      listener = event => {
        const {rotationRate: rate, accelerationIncludingGravity: force} = event;
        const values = [rate?.beta, rate?.gamma, rate?.alpha].map(value => value === null || value === undefined ? NaN : value * DEGREE);
        onRow({time: absolute(event.timeStamp), values: [...values, ...[force?.x, force?.y, force?.z].map(value => value ?? NaN)]});
      };
      const begin = (): void => { if (listener) window.addEventListener('devicemotion', listener); };
      const ask = given.DeviceMotionEvent?.requestPermission;
      if (ask) ask.call(given.DeviceMotionEvent).then(answer => { if (answer === 'granted') begin(); else onFault(DENIED); }, () => onFault(DENIED));
      else begin();
    },
    stop() { if (listener) window.removeEventListener('devicemotion', listener); listener = null; },
  };
}

export const openSensors = (): Sensors => given.Gyroscope ? genericSensors(given.Gyroscope, given.Accelerometer) : motionSensors();

const STILL_RATE = 0.02;   // standard deviations below which a phone lies, as the daemon has them
const STILL_FORCE = 0.3;

export function liesStill(rows: readonly Row[]): boolean {
  return NAMES.every((_, i) => {
    const values = rows.map(row => row.values[i] ?? NaN).filter(Number.isFinite);
    if (values.length === 0) return true;
    const mean = values.reduce((sum, value) => sum + value, 0) / values.length;
    return Math.sqrt(values.reduce((sum, value) => sum + (value - mean) ** 2, 0) / values.length) < (i < 3 ? STILL_RATE : STILL_FORCE);
  });
}
