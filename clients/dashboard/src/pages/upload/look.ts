// A look at the beginning of a file before it is sent: names and first values, nothing more. What they mean the daemon says.

export interface Column { name: string; first: string; course: number[] }
export interface Look { columns: Column[]; reason: string }

const HEAD_BYTES = 256 * 1024;
const COURSE = 120;

function npy(bytes: DataView): Look | null {
  const text = new TextDecoder('latin1').decode(bytes.buffer.slice(0, Math.min(bytes.byteLength, 512)));
  if (!text.startsWith('\x93NUMPY')) return null;
  const shape = /'shape':\s*\((\d+),\s*(\d*)\)/.exec(text);
  const count = shape?.[2] ? Number(shape[2]) : 1;
  return {columns: Array.from({length: Math.min(count, 64)}, (_, i) => ({name: String(i), first: '', course: []})), reason: 'numbered by the array'};
}

export async function lookAt(file: File): Promise<Look> {
  const buffer = await file.slice(0, HEAD_BYTES).arrayBuffer();
  const array = npy(new DataView(buffer));
  if (array) return array;
  const bytes = new Uint8Array(buffer);
  const binary = bytes.subarray(0, 2048).some(byte => byte === 0) || (bytes[0] === 0x1f && bytes[1] === 0x8b) || (bytes[0] === 0xfd && bytes[1] === 0x37);
  if (binary) return {columns: [], reason: 'the daemon reads the columns of this format'};
  const lines = new TextDecoder().decode(buffer).split(/\r?\n/).slice(0, -1).filter(line => line.trim() && !line.startsWith('#'));
  const heading = lines[0] ?? '';
  const separator = [',', ';', '\t'].find(each => heading.includes(each)) ?? ',';
  const cells = (line: string): string[] => line.split(separator).map(cell => cell.trim().replace(/^"(.*)"$/, '$1'));
  const names = cells(heading);
  const headed = names.some(name => name !== '' && Number.isNaN(Number(name)));
  const rows = lines.slice(headed ? 1 : 0, (headed ? 1 : 0) + COURSE * 4).map(cells);
  return {
    columns: names.slice(0, 64).map((name, i) => ({name: headed ? name : String(i), first: rows[0]?.[i] ?? '', course: rows.map(row => Number(row[i])).filter(value => Number.isFinite(value))})),
    reason: headed ? 'read from the header' : 'no header: numbered',
  };
}
