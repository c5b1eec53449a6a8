// What all pages with figures share, in one file as routes/shell.ts has it.
import {Figure, TableView, Tools, useWidth} from '../figure/Figure';
import {csvOf, save} from '../figure/export';
import {Spectrogram, ratiosCsv} from '../figure/Spectrogram';
import {unitsFor} from '../format/units';
import {columnName} from '../pages/device/documents';
import {MadeBy, Report} from '../shell/Report';

Object.freeze([Figure, TableView, Tools, useWidth, csvOf, save, Spectrogram, ratiosCsv, unitsFor, columnName, MadeBy, Report]);
