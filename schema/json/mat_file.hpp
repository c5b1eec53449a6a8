#pragma once
/// Any document as a MATLAB level 5 file, as MATLAB and GNU Octave load it.
///
/// Source: The MathWorks, "MAT-File Format", version R2020a, chapter 1. The file holds one variable, `result`, which
/// has the shape of the document: an object is a struct, a list of numbers a row of doubles with NaN for null, a list
/// of such lists of equal length a matrix, any other list a cell row; a text is a char row, true and false are logical,
/// null is
/// []. A whole number that no double holds is a text. Names that MATLAB does not take are changed: other characters
/// become `_`, an `x` goes before one that begins with no letter, 63 characters are kept, and a second of one name gets
/// `_2`. Little-endian, not compressed, without a date: equal documents give equal files.
#include "schema/json/json.hpp"

#include <string>

namespace driftlab {

/// The bytes of the file. Error: LimitExceeded for a document of more than 2 GiB, which the format does not hold.
[[nodiscard]] Result<std::string> mat_file(const Json& document);

}  // namespace driftlab
