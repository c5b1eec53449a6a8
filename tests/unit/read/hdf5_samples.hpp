#pragma once
/// Two small HDF5 files, made once with h5py 3.7 (libver latest, no times): arrays `gyro` (4 x 3, quarters) and `t`
/// (4, eighths); and the same format behind MATLAB's header of 512 bytes, with `gyro` of 5 x 2.
#include <string>
#include <string_view>

namespace driftlab::testing {

/// Hexadecimal; `z<n>;` stands for n zeros.
inline constexpr std::string_view kHdf5File =
    "894844460d0a1a0a030808z9;ffffffffffffffff8008z6;30z7;dc4d93b54f4844520220ab4d066bab4d066bab4d066bab4d066b78021"
    "2z4;ffffffffffffffffffffffffffffffff0a0200010000060f00000100046779726fc3z7;060c000001000174cf01z7;35z37;4d8c8a"
    "f74f48445202010001012400000202010104z7;03z7;04z7;03z7;0314000111203f0008z5;4000340b0034ff03000005020001030a081"
    "2000004010008z6;60z8;a0za2;4ec4628e4f48445202010001011400000201010104z7;04z7;0314000111203f0008z5;4000340b0034"
    "ff03000005020001030a0812000004016008z6;20z8;b0zb2;21d26c90z533;d03fz6;e03fz6;e83fz6;f03fz6;f43fz6;f83fz6;fc3fz"
    "7;40z6;0240z6;0440z6;0640ze;c03fz6;d03fz6;d83f";

/// Hexadecimal; `z<n>;` stands for n zeros.
inline constexpr std::string_view kMatlab73File =
    "4d41544c414220372e33204d41542d66696c652c206d61646520666f722061207465737420202020202020202020202020202020202020"
    "20202020202020202020202020202020202020202020202020202020202020202020202020202020202020202020202020202020202020"
    "202020202020z9;02494dz180;894844460d0a1a0a030808000002z6;ffffffffffffffff500az6;30z7;a148b40d4f4844520220ab4d0"
    "66bab4d066bab4d066bab4d066b780212z4;ffffffffffffffffffffffffffffffff0a0200010000060f00000100046779726fc3z8;45z"
    "47;ef5900654f48445202010001012400000202010102z7;05z7;02z7;05z7;0314000111203f0008z5;4000340b0034ff030000050200"
    "01030a0812000004010008z6;50z7;151200040000ffffffffffffffffffffffffffffffff0c28000003000d0008000400004d41544c41"
    "425f636c617373001301000006z3;02z3;646f75626c65005ez60;b86b8377z63f;f03fz7;40z6;0840z6;1040z6;1440z6;1840z6;1c4"
    "0z6;2040z6;2240";

/// The bytes of such a text.
inline std::string unfolded(std::string_view text) {
  std::string bytes;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == 'z') {
      const std::size_t end = text.find(';', i);
      bytes.append(std::stoul(std::string(text.substr(i + 1, end - i - 1)), nullptr, 16), '\0');
      i = end + 1;
    } else {
      bytes.push_back(static_cast<char>(std::stoul(std::string(text.substr(i, 2)), nullptr, 16)));
      i += 2;
    }
  }
  return bytes;
}

}  // namespace driftlab::testing
