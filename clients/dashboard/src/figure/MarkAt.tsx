// One point of a series.
import type {JSX} from 'preact';
import type {Mark} from './spec';

export function MarkAt({mark, x, y, colour, size = 3.4}: {mark: Mark; x: number; y: number; colour: string; size?: number}): JSX.Element {
  const hollow = {fill: 'var(--surface)', stroke: colour, 'stroke-width': 1.5};
  switch (mark) {
    case 'dot': return <circle cx={x} cy={y} r={size} fill={colour} />;
    case 'open': return <circle cx={x} cy={y} r={size} {...hollow} />;
    case 'diamond': return <path d={`M${x},${y - size - 1}L${x + size + 1},${y}L${x},${y + size + 1}L${x - size - 1},${y}Z`} {...hollow} />;
    case 'square': return <rect x={x - size} y={y - size} width={2 * size} height={2 * size} {...hollow} />;
    case 'triangle': return <path d={`M${x},${y - size - 0.8}L${x + size + 0.8},${y + size}L${x - size - 0.8},${y + size}Z`} fill={colour} />;
  }
}
