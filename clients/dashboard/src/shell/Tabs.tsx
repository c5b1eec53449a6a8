// The pages that share a place in the bar, as links below the head.
import type {JSX} from 'preact';
import {listOf, usePlace} from '../route';

const GROUPS: Record<string, readonly (readonly [string, string])[]> = {
  devices: [['devices', 'Devices'], ['populations', 'Populations'], ['data-sheets', 'Data sheets']],
  outages: [['outages', 'Simulated'], ['drives', 'Recorded drives']],
  jobs: [['jobs', 'Jobs'], ['webhooks', 'Webhooks']],
};

export function Tabs({group}: {group: keyof typeof GROUPS}): JSX.Element {
  const {parts} = usePlace();
  return <nav class="tabs no-print" aria-label="Pages beside this one">
    {GROUPS[group]!.map(([kind, name]) => <a key={kind} href={listOf(kind)} {...(parts[0] === kind ? {'aria-current': 'page' as const} : {})}>{name}</a>)}
  </nav>;
}
