// Measured against simulated: what the baseline says, and what remains against the extended model, on the same axes.
import type {JSX} from 'preact';
import {useMemo} from 'preact/hooks';
import {Figure, curlOf} from '../../figure/Figure';
import type {Plot, Series} from '../../figure/spec';
import {writeUnit} from '../../format/words';
import type {Investigation, SeriesDocument} from './documents';

const over = (values: readonly (number | null)[], by: readonly (number | null)[]): (number | null)[] => values.map((value, i) => { const base = by[i]; return value === null || base === null || base === undefined || base <= 0 ? null : value / base; });

function plotsOf(one: SeriesDocument): Plot[] {
  const {spectrum, wavelet} = one;
  const spectra = (id: string, name: string, values: readonly (number | null)[]): Plot => ({
    id, height: 130, hideX: id === 'before', x: {scale: 'linear', name: id === 'before' ? '' : 'frequency, Hz'}, y: {scale: 'log', name, domain: [0.05, Math.max(20, ...over(spectrum.measured, spectrum.baseline).map(value => (value ?? 0) * 1.3))]}, rules: [1],
    series: [{id: `${id}-spectrum`, name: id, noKey: true, x: spectrum.f_hz, y: over(values, spectrum.baseline), line: true, colour: 'var(--measured)', width: 1}],
  });
  void wavelet;
  return [spectra('before', 'before: measured ÷ baseline', spectrum.measured), spectra('after', 'after: what remains ÷ baseline', spectrum.remaining)];
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
    <Figure name={`${found.id}-spectrum`} title="Spectrum" sub={`${one.channel}, first recording, thinned by the API`} plots={spectra} source={source} curl={curlOf(`/v1/investigations/${found.id}`)}
      describe={`Two-sided density of ${one.channel} in ${writeUnit(one.unit)}²/Hz over the baseline, before and after the findings.`} note="This series is of the first recording alone and is thinned: narrow lines that a finding names may not show in it." />
    <Figure name={`${found.id}-wavelet`} title="Wavelet deviation" sub={<span>● measured · <span style={{color: 'var(--model)'}}>band: simulated, 95 %</span></span>} plots={wavelets} source={source} describe={`Haar wavelet deviation of ${one.channel} over the simulated median with the simulated 95 % band, before and after.`} />
  </div>;
}
