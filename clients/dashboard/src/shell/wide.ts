// Whether the screen has room for a third column (style/wide.css).
import {useEffect, useState} from 'preact/hooks';
import {usePaper} from './Report';

const WIDE = window.matchMedia('(min-width:2200px)');

export function useWide(): boolean {
  const [isWide, setWide] = useState(WIDE.matches);
  const isPaper = usePaper();
  useEffect(() => {
    const tell = (): void => setWide(WIDE.matches);
    WIDE.addEventListener('change', tell);
    return () => WIDE.removeEventListener('change', tell);
  }, []);
  return isWide && !isPaper;
}
