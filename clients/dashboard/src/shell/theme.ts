// System, light or dark; paper is always light.
export type Theme = 'system' | 'light' | 'dark';

const KEY = 'driftlab-theme';

export function themeNow(): Theme {
  try {
    const kept = localStorage.getItem(KEY);
    return kept === 'light' || kept === 'dark' ? kept : 'system';
  } catch { return 'system'; }
}

function apply(theme: Theme): void {
  document.documentElement.classList.toggle('dark', theme === 'dark');
  document.documentElement.classList.toggle('light', theme === 'light');
}

export function setTheme(theme: Theme): void {
  try { localStorage.setItem(KEY, theme); } catch { /* it holds for this page then */ }
  apply(theme);
}

export function startTheme(): void {
  apply(themeNow());
  window.addEventListener('beforeprint', () => apply('light'));
  window.addEventListener('afterprint', () => apply(themeNow()));
}
