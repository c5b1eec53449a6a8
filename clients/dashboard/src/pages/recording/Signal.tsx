// The whole recording at a glance, and by dragging down to its samples; what must not be taken for the sensor's noise is marked.
import type {JSX} from 'preact';
import {useMemo} from 'preact/hooks';
import {useRead} from '../../api/client';
import type {Channel, Histogram, Nullable, Recording, Trace} from '../../api/documents';
import {writeTick} from '../../format/number';
import {writeDuration} from '../../format/time';
import {sensorOf, writeUnit} from '../../format/words';
import {Figure} from '../../figure/Figure';
import {finite, type Plot, type Series, type Zone} from '../../figure/spec';
import {choose, usePlace} from '../../route';
import {curlOf} from '../../shell/copy';
import {Panel, Shown} from '../../shell/states';
import {foundIn, Places, placesOf, type Place} from './Places';

const POINTS = 1200;
const MEAN_SHOWN = 40;  // samples in a stretch from which on its mean is smoother than they are

const STYLES: Record<Place['kind'], Pick<Zone, 'style' | 'colour'>> = {
  trim: {style: 'shade', colour: 'var(--sunken)'}, gap: {style: 'hatch', colour: 'var(--ink2)'}, missing: {style: 'hatch', colour: 'var(--ink3)'},
  frozen: {style: 'foot', colour: 'var(--robust)'}, saturated: {style: 'top', colour: 'var(--robust)'}, flagged: {style: 'mark', colour: 'var(--robust)'},
  apart: {style: 'diamond', colour: 'var(--robust)'}, jump: {style: 'edge', colour: 'var(--robust)'}, level: {style: 'edge', colour: 'var(--robust)'},
};
const NAMES: Partial<Record<Place['kind'], string>> = {apart: 'values apart from the rest', jump: 'a jump of the mean', level: 'a change of the noise'};

// What is no measurement does not set the height of the figure, unless nothing else is there.
function domainOf(trace: Trace, places: readonly Place[]): readonly [number, number] | undefined {
  const wrong = places.filter(place => place.kind === 'flagged');
  if (wrong.length === 0) return undefined;
  const step = trace.samples_per_bucket / (trace.rate_hz ?? 1);
  const sound = trace.time_s.map(time => !wrong.some(place => place.t0 < time + step && place.t1 > time));
  const of = (values: Nullable): number[] => values.filter((value, i): value is number => sound[i]! && finite(value));
  const [low, high] = [Math.min(...of(trace.min)), Math.max(...of(trace.max))];
  return low < high ? [low - 0.05 * (high - low), high + 0.05 * (high - low)] : undefined;
}

function tracePlots(trace: Trace, places: readonly Place[]): Plot[] {
  const samples = trace.samples_per_bucket === 1;
  const series: Series = samples
    ? {id: 'samples', name: 'samples', x: trace.time_s, y: trace.mean, line: true, colour: 'var(--measured)', width: 1, noKey: true, ...(trace.time_s.length < 240 ? {mark: 'dot' as const} : {})}
    : {id: 'range', name: 'mean', x: trace.time_s, y: trace.mean, low: trace.min, high: trace.max, band: 'var(--measured)', line: trace.samples_per_bucket >= MEAN_SHOWN, colour: 'var(--surface)', width: 0.6, noKey: true};
  const domain = domainOf(trace, places);
  return [{id: 'trace', height: 130, x: {scale: 'linear', name: '', write: value => `${writeTick(Number(value.toPrecision(7)))} s`, domain: [trace.time_s[0] ?? 0, trace.time_s[trace.time_s.length - 1] ?? 1]},
    y: {scale: 'linear', name: writeUnit(trace.unit) || 'unit not stated', ...(domain ? {domain} : {})}, series: [series], zones: places.map(place => ({from: place.t0, to: place.t1, ...STYLES[place.kind]}))}];
}

export function Signal({recording, column, quantity, shape, channel}: {recording: Recording; column: string; quantity: string; shape: Histogram | undefined; channel: Channel | undefined}): JSX.Element {
  const place = usePlace();
  const from = place.query.get('t0');
  const to = place.query.get('t1');
  const zoomed = Boolean(from && to);
  const all = `/v1/recordings/${recording.id}/trace?channel=${encodeURIComponent(column)}&points=${POINTS}`;
  const path = zoomed ? `${all}&t0=${from}&t1=${to}` : all;
  const whole = useRead<Trace>(all);
  const near = useRead<Trace>(zoomed ? path : null);
  const read = zoomed ? near : whole;
  const found = useMemo(() => foundIn(recording, shape, channel), [recording, shape, channel]);
  const places = useMemo(() => read.data ? [...placesOf(read.data), ...found] : [], [read.data, found]);
  const plots = useMemo(() => read.data ? tracePlots(read.data, places) : [], [places]);
  if (!read.data) return <Panel title="Signal"><Shown read={read}>{() => null}</Shown></Panel>;
  const trace = read.data;
  const stretch = (trace.time_s[trace.time_s.length - 1] ?? 0) - (trace.time_s[0] ?? 0);
  return <Figure name={`${recording.metadata.id ?? recording.id}-signal`} title="Signal"
    sub={<>{trace.samples_per_bucket === 1 ? `${trace.mean.filter(finite).length} samples` : `least and greatest of every ${writeDuration(trace.samples_per_bucket / (trace.rate_hz ?? 1))}`}{zoomed ? <>, {writeDuration(stretch)} of {writeDuration(trace.duration_s ?? 0)} <button type="button" class="link" onClick={() => choose({t0: null, t1: null})}>Show all</button></> : <span class="no-print">, drag to enlarge</span>}</>}
    describe={`${sensorOf(quantity)} reading in ${writeUnit(trace.unit)} over ${writeDuration(stretch)}${places.length > 0 ? `; marked: ${[...new Set(places.map(each => NAMES[each.kind] ?? each.kind))].join(', ')}` : ''}.`} plots={plots} source={`driftlab, ${recording.id} ${column}, revision ${recording.revision}`} curl={curlOf(path)}
    note={<Places recording={recording} column={column} places={whole.data ? [...placesOf(whole.data), ...found] : places} duration={trace.duration_s ?? 0} rate={trace.rate_hz ?? 1} />}
    onZoom={(a, b) => choose({t0: a.toPrecision(7), t1: b.toPrecision(7)})} />;
}
