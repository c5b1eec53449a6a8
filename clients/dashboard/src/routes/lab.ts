// The page that is opened first, alone.
import '../app';
export {default as Lab} from '../pages/Lab';
