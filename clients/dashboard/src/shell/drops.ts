// A file that is dropped beside a drop zone is for the page of uploads; the browser would leave the lab to show it.
import {go} from '../route';

// What is dropped can be asked for during the event alone.
export interface Dropped { entries: FileSystemEntry[]; files: File[] }

export const droppedOf = (data: DataTransfer): Dropped => ({entries: [...data.items].map(item => item.webkitGetAsEntry?.()).filter((entry): entry is FileSystemEntry => Boolean(entry)), files: [...data.files]});

const holdsFiles = (event: DragEvent): boolean => event.dataTransfer?.types.includes('Files') ?? false;

// Heard behind the pages' own listeners, which are on the document and take what is theirs.
export function startDrops(): void {
  window.addEventListener('dragover', event => { if (holdsFiles(event)) event.preventDefault(); });
  window.addEventListener('drop', event => {
    if (event.defaultPrevented || !event.dataTransfer || !holdsFiles(event)) return;
    event.preventDefault();
    const dropped = droppedOf(event.dataTransfer);
    import('../routes/lists').then(async pages => { pages.askFor(await pages.filesOf(dropped)); go('/upload'); }, () => window.location.reload());
  });
}
