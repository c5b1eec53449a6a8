// The whole recording at a glance, and by dragging down to its samples.
import type {JSX} from 'preact';
import {useMemo} from 'preact/hooks';
import {useRead} from '../../api/client';
import type {Recording, Trace} from '../../api/documents';
import {writeTick} from '../../format/number';
import {writeDuration} from '../../format/time';
import {sensorOf, writeUnit} from '../../format/words';
import {curlOf, Figure} from '../../figure/Figure';
import type {Plot, Series} from '../../figure/spec';
import {choose, usePlace} from '../../route';
import {Panel, Shown} from '../../shell/states';

const POINTS = 1200;
const MEAN_SHOWN = 40;  // samples in a stretch from which on its mean is smoother than they are

function tracePlots(trace: Trace): Plot[] {
  const samples = trace.samples_per_bucket === 1;
  const series: Series = samples
    ? {id: 'samples', name: 'samples', x: trace.time_s, y: trace.mean, line: true, colour: 'var(--measured)', width: 1, noKey: true, ...(trace.time_s.length < 240 ? {mark: 'dot' as const} : {})}
    : {id: 'range', name: 'mean', x: trace.time_s, y: trace.mean, low: trace.min, high: trace.max, band: 'var(--measured)', line: trace.samples_per_bucket >= MEAN_SHOWN, colour: 'var(--surface)', width: 0.6, noKey: true};
  return [{id: 'trace', height: 130, x: {scale: 'linear', name: '', write: value => `${writeTick(Number(value.toPrecision(7)))} s`, domain: [trace.time_s[0] ?? 0, trace.time_s[trace.time_s.length - 1] ?? 1]}, y: {scale: 'linear', name: writeUnit(trace.unit) || 'unit not stated'}, series: [series]}];
}

export function Signal({recording, column, quantity}: {recording: Recording; column: string; quantity: string}): JSX.Element {
  const place = usePlace();
  const from = place.query.get('t0');
  const to = place.query.get('t1');
  const path = `/v1/recordings/${recording.id}/trace?channel=${encodeURIComponent(column)}&points=${POINTS}${from && to ? `&t0=${from}&t1=${to}` : ''}`;
  const read = useRead<Trace>(path);
  const plots = useMemo(() => read.data ? tracePlots(read.data) : [], [read.data]);
  if (!read.data) return <Panel title="Signal"><Shown read={read}>{() => null}</Shown></Panel>;
  const trace = read.data;
  const stretch = (trace.time_s[trace.time_s.length - 1] ?? 0) - (trace.time_s[0] ?? 0);
  return <Figure name={`${recording.metadata.id ?? recording.id}-signal`} title="Signal"
    sub={<>{trace.samples_per_bucket === 1 ? `${trace.time_s.length} samples` : `least and greatest of every ${writeDuration(trace.samples_per_bucket / (trace.rate_hz ?? 1))}`}{from && to ? <>, {writeDuration(stretch)} of {writeDuration(trace.duration_s ?? 0)} <button type="button" class="link" onClick={() => choose({t0: null, t1: null})}>Show all</button></> : <span class="no-print">, drag to enlarge</span>}</>}
    describe={`${sensorOf(quantity)} reading in ${writeUnit(trace.unit)} over ${writeDuration(stretch)}.`} plots={plots} source={`driftlab, ${recording.id} revision ${recording.revision}`} curl={curlOf(path)}
    onZoom={(a, b) => choose({t0: a.toPrecision(7), t1: b.toPrecision(7)})} />;
}
