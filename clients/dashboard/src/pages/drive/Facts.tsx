// What is true of the files of a drive before any filter.
import type {JSX} from 'preact';
import {writeCount, writeNumber, writeTick} from '../../format/number';
import {writeDuration} from '../../format/time';
import {plural} from '../../format/words';
import {Panel} from '../../shell/states';
import type {Facts} from './documents';

const hz = (rate: number): string => `${writeTick(Number(rate.toPrecision(4)))} Hz`;

// The drive in one sentence.
export function driveSentence(facts: Facts): string {
  const length = facts.length_m >= 1000 ? `${writeNumber(facts.length_m / 1000)} km` : `${writeNumber(facts.length_m)} m`;
  return `${length} in ${writeDuration(facts.duration_s)}, ${writeNumber(facts.highest_speed_m_s * 3.6, 2)} km/h at most; ${writeCount(facts.imu.rows)} readings at ${hz(facts.imu.sensor_rate_hz)}, ${writeCount(facts.gnss.fixes)} fixes at ${hz(facts.gnss.rate_hz)}.`;
}

function faultsOf({imu, gnss, runs}: Facts): string[] {
  const counted = (count: number, text: string): string[] => count > 0 ? [`${writeCount(count)} ${text}`] : [];
  return [
    ...(imu.polled_faster_than_sampled ? [`the unit is polled at ${hz(imu.stamped_rate_hz)} and samples at ${hz(imu.sensor_rate_hz)}`] : []),
    ...counted(imu.repeated_rows, 'rows repeat the one before'), ...counted(imu.stuck_rows, 'rows of a stuck sensor'), ...counted(imu.incomplete_rows, 'rows are incomplete'),
    ...(imu.gaps_bridged > 0 ? [`${plural(imu.gaps_bridged, 'gap')} of ${plural(imu.samples_bridged, 'sample')} bridged`] : []),
    ...(imu.gaps_splitting > 0 ? [`${plural(imu.gaps_splitting, 'gap')}, ${writeDuration(imu.longest_gap_s)} at most, part the drive into ${plural(runs, 'run')}`] : []),
    ...counted(gnss.held, 'rows repeat a fix'), ...counted(gnss.other_types, 'fixes of other types'), ...counted(gnss.incomplete, 'fixes are incomplete'), ...counted(gnss.far_away, 'fixes are far away'),
    ...(gnss.accuracy_constant ? ['the stated accuracy of positions never changes'] : []), ...(gnss.speed_accuracy_constant ? ['the stated accuracy of speeds never changes'] : []),
  ];
}

function Row({name, value, unit, note}: {name: string; value: number; unit: string; note: string}): JSX.Element {
  return <tr><th scope="row">{name}</th><td class="n"><b>{Number.isInteger(value) ? writeCount(value) : writeNumber(value)}</b></td><td class="u">{unit}</td><td class="u">{note}</td></tr>;
}

export function FactsPanel({facts}: {facts: Facts}): JSX.Element {
  const faults = faultsOf(facts);
  return <Panel title="Facts of the files" sub="before any filter">
    <table class="params"><tbody>
      <Row name="Way" value={facts.length_m >= 1000 ? facts.length_m / 1000 : facts.length_m} unit={facts.length_m >= 1000 ? 'km' : 'm'} note={writeDuration(facts.duration_s)} />
      <Row name="Highest speed" value={facts.highest_speed_m_s} unit="m/s" note={`${writeNumber(facts.highest_speed_m_s * 3.6)} km/h`} />
      <Row name="Readings" value={facts.imu.rows} unit="" note={`${hz(facts.imu.sensor_rate_hz)}, jitter ${facts.imu.jitter_s < 1e-6 ? 'none' : `${writeNumber(facts.imu.jitter_s * 1e3, 2)} ms`}`} />
      <Row name="Fixes" value={facts.gnss.fixes} unit="" note={hz(facts.gnss.rate_hz)} />
    </tbody></table>
    {faults.length > 0 ? <ul class="rows plain">{faults.map(fault => <li key={fault}>{fault}</li>)}</ul> : <p class="note">No repeats, no gaps, nothing incomplete.</p>}
    {facts.notes.map(note => <p key={note} class="note">{note}</p>)}
  </Panel>;
}
