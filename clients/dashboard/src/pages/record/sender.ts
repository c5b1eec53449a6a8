// Samples on their way to the daemon: a numbered piece every second, kept until it was acknowledged.
import type {Row} from './sensors';

const EVERY_MS = 1000;
const MOST_ROWS = 2000;     // in a piece, after the network was away
const FIRST_NUMBER_S = 1577836800;  // 2020: numbers of a page that was loaded again come behind those of the page before

interface Piece { number: number; rows: Row[] }

export class Sender {
  private waiting: Row[] = [];
  private pieces: Piece[] = [];
  private next = Math.floor(Date.now() / 1000) - FIRST_NUMBER_S;
  private timer = 0;
  private busy = false;

  constructor(private readonly id: string, private readonly token: string, private readonly onState: (unsent: number, problem: string | null) => void) {}

  start(): void { this.timer = window.setInterval(() => { this.cut(); void this.send(); }, EVERY_MS); }

  add(row: Row): void {
    const last = this.waiting[this.waiting.length - 1];
    if (!last || row.time > last.time) this.waiting.push(row);  // the same instant again is none
  }

  // Everything is with the daemon, or the reason why not.
  async flush(): Promise<void> {
    window.clearInterval(this.timer);
    this.cut();
    for (let attempt = 0; this.pieces.length > 0 && attempt < 5; ++attempt) {
      await this.send();
      if (this.pieces.length > 0) await new Promise(resolve => setTimeout(resolve, 500 * (attempt + 1)));
    }
    if (this.pieces.length > 0) throw new Error('Some samples are not stored yet; the daemon does not answer. They are kept while this page is open.');
  }

  private cut(): void {
    while (this.waiting.length > 0) this.pieces.push({number: this.next++, rows: this.waiting.splice(0, MOST_ROWS)});
  }

  private async send(): Promise<void> {
    if (this.busy) return;
    this.busy = true;
    try {
      while (this.pieces.length > 0) {
        const piece = this.pieces[0]!;
        const answer = await fetch(`/v1/live-recordings/${this.id}/samples?sequence=${piece.number}`, {method: 'POST', body: bytesOf(piece.rows), headers: {'Content-Type': 'application/octet-stream', 'Live-Token': this.token}});
        if (!answer.ok) throw new Error(((await answer.json().catch(() => null)) as {detail?: string} | null)?.detail ?? `The daemon answered ${answer.status}.`);
        this.pieces.shift();
      }
      this.onState(0, null);
    } catch (error) {
      this.onState(this.pieces.reduce((sum, piece) => sum + piece.rows.length, 0), error instanceof TypeError ? 'The daemon does not answer; samples are kept here meanwhile.' : (error as Error).message);
    } finally {
      this.busy = false;
    }
  }
}

// Rows as the daemon takes them: a float64 time, then float32 values, little-endian.
export function bytesOf(rows: readonly Row[]): ArrayBuffer {
  const columns = rows[0]?.values.length ?? 0;
  const length = 8 + 4 * columns;
  const view = new DataView(new ArrayBuffer(rows.length * length));
  rows.forEach((row, i) => {
    view.setFloat64(i * length, row.time, true);
    row.values.forEach((value, c) => view.setFloat32(i * length + 8 + 4 * c, value, true));
  });
  return view.buffer;
}
