// What needs a library of its own: the code that a phone reads.
import '../app';
import './figures';
export {default as Record} from '../pages/Record';
