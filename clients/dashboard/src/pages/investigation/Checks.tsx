// Where it was looked, and how much: recordings and axes against kinds of checks.
import type {JSX} from 'preact';
import {plural} from '../../format/words';
import {usePlace} from '../../route';
import {checkKind, columnOf, keyOf, restsOn, type Check, type Investigation} from './documents';

const CELL = 22;
const LEFT = 190;
const TOP = 118;
const UNCORRECTED = 0.05;

function mended(check: Check, found: Investigation): boolean {
  if (check.end) return check.end !== 'unexplained';
  return !found.unexplained.some(one => one.checks.includes(check.id)) && found.findings.some(finding => restsOn(finding, [check]).length > 0);
}

export function Checks({found, names}: {found: Investigation; names: Map<string, string>}): JSX.Element {
  const rows = [...new Set(found.checks.map(check => `${check.recording ?? ''}\u0001${columnOf(check.channel)}`))];
  const kinds = [...new Set(found.checks.map(checkKind))];
  const at = new Map<string, Check>(found.checks.map(check => [`${check.recording ?? ''}\u0001${columnOf(check.channel)}\u0001${checkKind(check)}`, check] as const));
  // Names lean to the right, over the last column.
  const width = LEFT + kinds.length * CELL + 110;
  const failed = found.checks.filter(check => check.failed);
  const lit = usePlace().query.get('lit');
  const marked = new Set(found.findings.filter(finding => keyOf(finding, found.findings) === lit).flatMap(finding => restsOn(finding, found.checks)));
  return <>
    <div class="checks" tabIndex={0} role="region" aria-label="Checks"><svg viewBox={`0 0 ${width} ${TOP + rows.length * CELL + 6}`} width={width} height={TOP + rows.length * CELL + 6} role="img" aria-label={`${found.checks.length} checks in ${rows.length} rows of ${kinds.length} kinds; ${failed.length} failed: ${failed.map(check => `${columnOf(check.channel)} ${checkKind(check)}`).join(', ') || 'none'}.`}>
      {kinds.map((kind, i) => <text key={kind} class="s" transform={`translate(${LEFT + i * CELL + 14},${TOP - 8}) rotate(-52)`}>{kind}</text>)}
      {rows.map((row, j) => {
        const [recording = '', column = ''] = row.split('\u0001');
        const first = j === 0 || !rows[j - 1]!.startsWith(recording);
        const y = TOP + j * CELL + CELL / 2;
        return <g key={row}>
          {first && <text class="t" x="0" y={y + 4}>{(recording ? names.get(recording) ?? '' : 'whole study').slice(0, 16)}</text>}
          <text class="s" x={LEFT - 8} y={y + 4} text-anchor="end">{column.slice(0, 14)}</text>
          {kinds.map((kind, i) => {
            const check = at.get(`${row}\u0001${kind}`);
            if (!check) return null;
            const x = LEFT + i * CELL + CELL / 2;
            return <g key={kind}>{marked.has(check) && <circle class="lit" cx={x} cy={y} r="9.5" fill="none" stroke="var(--focus)" stroke-width="2" />}
              {check.failed ? <rect x={x - 5} y={y - 5} width="10" height="10" fill={mended(check, found) ? 'var(--surface)' : 'var(--robust)'} stroke="var(--robust)" stroke-width="1.8" />
                : <circle cx={x} cy={y} r={check.p !== null && check.p < UNCORRECTED ? 3 : 1.1} fill="var(--ink3)" />}</g>;
          })}
        </g>;
      })}
    </svg></div>
    <p class="note"><b style={{color: 'var(--robust)'}}>■</b> fails and no finding explains it · <b style={{color: 'var(--robust)'}}>□</b> the findings mend it · ● p &lt; 0.05 but not after correction for {plural(found.checks.length, 'check')} · · agrees</p>
  </>;
}
