import {writeNumber} from './number';

const MONTHS = ['Jan', 'Feb', 'Mar', 'Apr', 'May', 'Jun', 'Jul', 'Aug', 'Sep', 'Oct', 'Nov', 'Dec'];
const LONG_MONTHS = ['January', 'February', 'March', 'April', 'May', 'June', 'July', 'August', 'September', 'October', 'November', 'December'];
const DAYS = ['Sunday', 'Monday', 'Tuesday', 'Wednesday', 'Thursday', 'Friday', 'Saturday'];
const two = (n: number): string => String(n).padStart(2, '0');

// 07:24 today, 22 Nov 2026 else; UTC.
export function writeWhen(at: string, now: Date = new Date()): string {
  const time = new Date(at);
  if (Number.isNaN(time.getTime())) return '–';
  if (time.toISOString().slice(0, 10) === now.toISOString().slice(0, 10)) return `${two(time.getUTCHours())}:${two(time.getUTCMinutes())}`;
  return `${time.getUTCDate()} ${MONTHS[time.getUTCMonth()]} ${time.getUTCFullYear()}`;
}

export function writeClock(at: string): string {
  return new Date(at).toISOString().slice(11, 19);
}

// 07:24:51 today, 22 Nov 2026 07:24:51 else.
export function writeMoment(at: string, now: Date = new Date()): string {
  const when = writeWhen(at, now);
  return when.includes(':') ? writeClock(at) : `${when} ${writeClock(at)}`;
}

export const writeFull = (at: string): string => `${new Date(at).toISOString().replace('T', ' ').slice(0, 19)} UTC`;

export function writeToday(now: Date): string {
  return `${DAYS[now.getUTCDay()]} ${now.getUTCDate()} ${LONG_MONTHS[now.getUTCMonth()]} ${now.getUTCFullYear()}, ${two(now.getUTCHours())}:${two(now.getUTCMinutes())} UTC`;
}

export function writeDuration(seconds: number): string {
  if (seconds < 10) return `${writeNumber(seconds, 2)} s`;
  if (seconds < 90) return `${Math.round(seconds)} s`;
  if (seconds < 5400) {
    const rest = Math.round(seconds % 60);
    return `${Math.floor(seconds / 60)} min${rest > 0 && rest < 60 ? ` ${rest} s` : ''}`;
  }
  const minutes = Math.round((seconds % 3600) / 60);
  return `${Math.floor(seconds / 3600)} h${minutes > 0 ? ` ${minutes} min` : ''}`;
}
