// What the shell and all pages share, so that it comes in one file with the shell: a page's own file is then all that it asks for.
import {Fragment} from 'preact';
import {useEffect, useId, useLayoutEffect, useMemo, useRef, useState} from 'preact/hooks';
import {jsx} from 'preact/jsx-runtime';
import {get, remove, send, useJobEvents, useRead} from '../api/client';
import {useEvents} from '../api/events';
import {MarkAt} from '../figure/MarkAt';
import {decadeTicks, linear, logarithmic, ticksBetween} from '../figure/scale';
import {finite} from '../figure/spec';
import {writeBytes, writeCount, writeNumber, writeP, writeQuantity, writeShare, writeTick} from '../format/number';
import {writeDuration, writeFull, writeToday, writeWhen} from '../format/time';
import {capital, conditionName, countWord, jobKind, listWords, plural, processName, sensorOf, spaced, symbolOf, writeSentence, writeUnit} from '../format/words';
import {choose, go, hover, listOf, pageOf, usePlace} from '../route';
import {sourceOf, useSheets, writeStated} from '../pages/datasheet/documents';
import {ConditionField} from '../pages/upload/ConditionField';
import {RunAgain} from '../shell/Again';
import {Characterise} from '../shell/Characterise';
import {copy, curlOf} from '../shell/copy';
import {Delete} from '../shell/Delete';
import {openDrawer} from '../shell/Drawer';
import {Head, Verdict} from '../shell/Head';
import {usePageKeys} from '../shell/keys';
import {LastResult} from '../shell/LastResult';
import {NextRows, Pager} from '../shell/Pager';
import {say} from '../shell/say';
import {Sought} from '../shell/Sought';
import {Hairlines, Panel, Progress, Refusal, Segments, Shown} from '../shell/states';
import {useTitle} from '../shell/title';

// A call, which the bundler keeps in whatever imports this file: it then finds all of these in one place.
Object.freeze([Fragment, useEffect, useId, useLayoutEffect, useMemo, useRef, useState, jsx, get, remove, send, useJobEvents, useRead, useEvents, MarkAt, decadeTicks, linear, logarithmic, ticksBetween, finite,
  writeBytes, writeCount, writeNumber, writeP, writeQuantity, writeShare, writeTick, writeDuration, writeFull, writeToday, writeWhen,
  capital, conditionName, countWord, jobKind, listWords, plural, processName, sensorOf, spaced, symbolOf, writeSentence, writeUnit,
  choose, go, hover, listOf, pageOf, usePlace, Characterise, copy, curlOf, Delete, openDrawer, Head, RunAgain, Verdict, usePageKeys, LastResult, NextRows, Pager, say, Sought,
  Hairlines, Panel, Progress, Refusal, Segments, Shown, useTitle, sourceOf, useSheets, writeStated, ConditionField]);
