// All keys, and how the pages look in this browser.
import type {JSX} from 'preact';
import {densityNow, setDensity, setTheme, themeNow, type Density, type Theme} from './theme';
import {useState} from 'preact/hooks';
import {openDrawer} from './Drawer';
import {Segments} from './states';

const KEYS: readonly (readonly [string, string])[] = [
  ['/', 'find'], ['g then l d i o r j', 'go to Lab, Devices, Investigations, Outages, Regressions, Jobs'], ['g then p s v w', 'go to Populations, Data sheets, Drives, Webhooks'],
  ['u', 'upload'], ['c', 'compare'], ['1 2 3', 'axis x, y, z'],
  ['[ ]', 'recording or outage before, after'], ['← →', 'in a figure: point before, after'], ['↑ ↓', 'in a figure: curve'], ['Home End', 'in a figure: first, last point'], ['Enter', 'in a figure: pin the cursor'],
  ['t', 'in a figure: its table'], ['Esc', 'close, or unpin'], ['?', 'this list'],
];

function Keys(): JSX.Element {
  const [theme, show] = useState<Theme>(themeNow());
  const [density, showDensity] = useState<Density>(densityNow());
  return <>
    <dl>{KEYS.map(([key, what]) => <><dt key={key}><kbd>{key}</kbd></dt><dd>{what}</dd></>)}</dl>
    <h3>Theme</h3>
    <p><Segments label="Theme" options={[['system', 'System'], ['light', 'Light'], ['dark', 'Dark']] as const} value={theme} onChange={value => { setTheme(value); show(value); }} /></p>
    <h3>Rows</h3>
    <p><Segments label="Rows" options={[['compact', 'Compact'], ['comfortable', 'Comfortable']] as const} value={density} onChange={value => { setDensity(value); showDensity(value); }} /></p>
  </>;
}

export const openKeys = (): void => openDrawer('Keys and settings', Keys);
