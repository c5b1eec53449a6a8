// How the pages look in this browser: system, light or dark, paper always being light; rows compact or comfortable.
export type Theme = 'system' | 'light' | 'dark';
export type Density = 'compact' | 'comfortable';

const THEME = 'driftlab-theme';
const DENSITY = 'driftlab-density';

// What a browser keeps, if it keeps anything: else a choice holds for this page.
function kept(key: string): string | null {
  try { return localStorage.getItem(key); } catch { return null; }
}
function keep(key: string, value: string): void {
  try { localStorage.setItem(key, value); } catch { /* it holds for this page then */ }
}

export function themeNow(): Theme {
  const theme = kept(THEME);
  return theme === 'light' || theme === 'dark' ? theme : 'system';
}

export const densityNow = (): Density => kept(DENSITY) === 'comfortable' ? 'comfortable' : 'compact';

const mark = (name: string, on: boolean): void => { document.documentElement.classList.toggle(name, on); };

function apply(theme: Theme): void {
  mark('dark', theme === 'dark');
  mark('light', theme === 'light');
}

export function setTheme(theme: Theme): void {
  keep(THEME, theme);
  apply(theme);
}

export function setDensity(density: Density): void {
  keep(DENSITY, density);
  mark('comfortable', density === 'comfortable');
}

export function startTheme(): void {
  apply(themeNow());
  mark('comfortable', densityNow() === 'comfortable');
  window.addEventListener('beforeprint', () => apply('light'));
  window.addEventListener('afterprint', () => apply(themeNow()));
}
