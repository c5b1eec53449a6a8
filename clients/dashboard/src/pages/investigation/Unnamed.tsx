// What no listed cause explains and the extended model holds all the same: measured profiles beside the model.
import type {JSX} from 'preact';
import {Figure} from '../../figure/Figure';
import type {Plot} from '../../figure/spec';
import {writeNumber} from '../../format/number';
import {spaced, writeSentence, writeUnit} from '../../format/words';
import {curlOf} from '../../shell/copy';
import {columnOf, type Investigation, type Profile} from './documents';

const NAMES = {spectrum: 'density ÷ model', variance: 'power of the noise ÷ model', mean: 'mean'};

const plotOf = (one: Profile): Plot => ({id: 'profile', height: 200, rules: [one.kind === 'mean' ? 0 : 1],
  x: {scale: one.against === 'frequency' ? 'log' : 'linear', name: `${spaced(one.against)}, ${writeUnit(one.along)}`}, y: {scale: 'linear', name: one.unit ? `mean, ${writeUnit(one.unit)}` : NAMES[one.kind]},
  series: [{id: 'profile', name: 'measured', x: one.middles, y: one.values, low: one.q025, high: one.q975, mark: 'dot', colour: 'var(--measured)', noKey: true}]});

export function Unnamed({found}: {found: Investigation}): JSX.Element {
  return <>{(found.unnamed ?? []).map((one, i) => <Figure key={i} name={`${found.id}-unnamed-${i + 1}`} title={`${columnOf(one.channel)} by ${spaced(one.against)}`} sub={`without a name · held-out gain ${writeNumber(one.gain.log_score, 3)} nats`}
    plots={[plotOf(one)]} source={`driftlab, ${found.id}`} curl={curlOf(`/v1/investigations/${found.id}`)} describe={one.explanation} note={writeSentence(`${one.explanation}. No listed cause explains it; the extended model holds it as it was measured.`)} />)}</>;
}
