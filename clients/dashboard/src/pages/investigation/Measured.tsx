// Measured against simulated: what the baseline says, and what remains against the extended model, on the same axes.
import type {JSX} from 'preact';
import {useMemo} from 'preact/hooks';
import {Figure, curlOf} from '../../figure/Figure';
import type {Plot, Series} from '../../figure/spec';
import {writeUnit} from '../../format/words';
import type {Investigation, SeriesDocument} from './documents';

const over = (values: readonly (number | null)[], by: readonly (number | null)[]): (number | null)[] => values.map((value, i) => { const base = by[i]; return value === null || base === null || base === undefined || base <= 0 ? null : value / base; });

function plotsOf(one: SeriesDocument): Plot[] {
  const {spectrum} = one;
  const base = spectrum.baseline.median;
  const spectra = (id: string, name: string, values: readonly (number | null)[], highest: readonly (number | null)[]): Plot => ({
    id, height: 130, hideX: id === 'before', x: {scale: 'linear', name: id === 'before' ? '' : 'frequency, Hz'}, y: {scale: 'log', name, domain: [0.05, Math.max(20, ...over(spectrum.highest, base).map(value => (value ?? 0) * 1.3))]}, rules: [1],
    series: [
      {id: `${id}-highest`, name: 'highest of each bin', x: spectrum.f_hz, y: over(highest, base), line: true, colour: 'var(--robust)', width: 1, noKey: true},
      {id: `${id}-chance`, name: 'chance, 1 in 20', x: spectrum.f_hz, y: over(spectrum.chance, base), line: true, colour: 'var(--ink3)', width: 1, noKey: true},
      {id: `${id}-spectrum`, name: 'mean', noKey: true, x: spectrum.f_hz, y: over(values, base), low: over(spectrum.baseline.q025, base), high: over(spectrum.baseline.q975, base), band: 'var(--modelband)', line: true, colour: 'var(--measured)', width: 1},
    ],
  });
  return [spectra('before', 'before: measured ÷ baseline', spectrum.measured, spectrum.highest), spectra('after', 'after: what remains ÷ baseline', spectrum.remaining, spectrum.highest_remaining)];
}

function waveletPlot(one: SeriesDocument): Plot[] {
  const {wavelet} = one;
  const band = (id: string, name: string, measured: readonly (number | null)[], of: SeriesDocument['wavelet']['baseline']): Plot => {
    const ratio = (values: readonly (number | null)[]): (number | null)[] => over(values, of.median);
    const series: Series[] = [
      {id: `${id}-band`, name: 'simulated, 95 %', x: wavelet.scale_s, y: ratio(of.median), low: ratio(of.q025), high: ratio(of.q975), band: 'var(--modelband)', line: true, colour: 'var(--model)', noKey: true},
      {id: `${id}-measured`, name: 'measured', x: wavelet.scale_s, y: ratio(measured), mark: 'dot', colour: 'var(--measured)', noKey: true},
    ];
    return {id, height: 130, hideX: id === 'before', x: {scale: 'log', name: id === 'before' ? '' : 'scale, s'}, y: {scale: 'log', name, domain: [0.5, 2], ticks: [0.5, 0.7, 1, 1.4, 2]}, rules: [1], series};
  };
  return [band('before', 'before: deviation ÷ simulated', wavelet.measured, wavelet.baseline), band('after', 'after: remaining ÷ simulated', wavelet.remaining, wavelet.extended)];
}

export function Measured({found, one}: {found: Investigation; one: SeriesDocument}): JSX.Element {
  const spectra = useMemo(() => plotsOf(one), [one]);
  const wavelets = useMemo(() => waveletPlot(one), [one]);
  const source = `driftlab, ${found.id}, ${one.channel}`;
  return <div class="grid wide-side">
    <Figure name={`${found.id}-spectrum`} title="Spectrum" sub={<span>{one.channel}, mean of all recordings · <span style={{color: 'var(--robust)'}}>highest of each bin</span> · what chance reaches</span>} plots={spectra} source={source} curl={curlOf(`/v1/investigations/${found.id}`)}
      describe={`Two-sided density of ${one.channel} in ${writeUnit(one.unit)}²/Hz over the baseline, before and after the findings.`} />
    <Figure name={`${found.id}-wavelet`} title="Wavelet deviation" sub={<span>● measured · <span style={{color: 'var(--model)'}}>band: simulated, 95 %</span></span>} plots={wavelets} source={source} describe={`Haar wavelet deviation of ${one.channel} over the simulated median with the simulated 95 % band, before and after.`} />
  </div>;
}
