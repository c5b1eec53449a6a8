// What a live recording says so far, as the daemon tells it.
import type {JSX} from 'preact';
import {useEffect, useMemo, useState} from 'preact/hooks';
import type {Ends, Nullable, Quantity} from '../../api/documents';
import {writeQuantity} from '../../format/number';
import {writeDuration} from '../../format/time';
import {factorBetween, unitsFor} from '../../format/units';
import {writeUnit} from '../../format/words';
import {Figure} from '../../figure/Figure';
import type {Plot} from '../../figure/spec';
import {Segments} from '../../shell/states';

export interface Growing {
  samples: number; seconds: number | null; rate_hz: number | null; gaps: number; unit: string; channel: string; still: boolean | null;
  allan: {tau_s: number[]; deviation: Nullable; ci95: Ends[]}; N: Quantity | null; N_reason: string | null; next: {tau_s: number; in_s: number} | null;
}

const ENOUGH = 0.05;  // of N, half the length of its interval

export function useGrowth(id: string | null, channel: string, onFinished: () => void): Growing | null {
  const [growing, setGrowing] = useState<Growing | null>(null);
  useEffect(() => {
    if (!id) return undefined;
    const stream = new EventSource(`/v1/live-recordings/${id}/events?channel=${channel}`);
    stream.addEventListener('growth', event => setGrowing(JSON.parse((event as MessageEvent<string>).data) as Growing));
    stream.addEventListener('finished', () => { stream.close(); onFinished(); });
    return () => stream.close();
  }, [id, channel]);
  return growing;
}

function growthPlots(growing: Growing): Plot[] {
  const unit = unitsFor(growing.unit)[0]!;
  const factor = factorBetween(growing.unit, unit);
  const times = (values: Nullable): Nullable => values.map(value => value === null ? null : value * factor);
  const {allan} = growing;
  return [{id: 'growth', equalDecades: true, x: {scale: 'log', name: 'τ, s'}, y: {scale: 'log', name: `Allan deviation, ${writeUnit(unit)}`},
    series: [{id: 'so-far', name: 'so far', noKey: true, x: allan.tau_s, y: times(allan.deviation), low: times(allan.ci95.map(ends => ends[0] ?? null)), high: times(allan.ci95.map(ends => ends[1] ?? null)), mark: 'dot', line: true, colour: 'var(--measured)', band: 'var(--band)', width: 0.8}]}];
}

function enough(n: Quantity | null): boolean {
  const [low, high] = n?.ci95 ?? [];
  return Boolean(n && n.value && low && high && (high - low) / 2 < ENOUGH * n.value);
}

export function GrowthPanel({growing, channel, onChannel}: {growing: Growing | null; channel: string; onChannel: (channel: string) => void}): JSX.Element {
  const plots = useMemo(() => growing && growing.allan.tau_s.length > 1 ? growthPlots(growing) : null, [growing]);
  const controls = <Segments label="Axis" options={[['gx', 'x'], ['gy', 'y'], ['gz', 'z']] as const} value={channel as 'gx' | 'gy' | 'gz'} onChange={onChannel} />;
  const n = growing?.N ?? null;
  const written = n ? writeQuantity(n) : null;
  return <>
    {plots ? <Figure name="live-allan" title="Allan deviation so far" controls={controls} describe={`Allan deviation of ${channel} from ${growing!.samples} samples so far.`} plots={plots} source={`driftlab, live recording, ${channel}`}
      note={growing?.next ? `The next point, τ ${growing.next.tau_s.toPrecision(3)} s, comes in ${writeDuration(Math.max(1, Math.round(growing.next.in_s)))}.` : ''} />
      : <section class="panel"><div class="ptop"><h2>Allan deviation so far</h2>{controls}</div><p class="sec">The first points come after a second or two.</p></section>}
    <section class="panel live-facts" aria-live="polite">
      <div><span class="sec">white noise N</span><strong>{written ? <>{written.value} <small>{writeUnit(n?.unit)}</small></> : '…'}</strong><span class="sec">{written ? written.interval : growing?.N_reason ?? ''}</span></div>
      <div><span class="sec">enough for N</span><strong>{enough(n) ? 'yes' : 'not yet'}</strong><span class="sec">for a slow bias: 15 min or more</span></div>
    </section>
  </>;
}
