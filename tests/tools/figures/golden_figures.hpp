// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <string>
#include <utility>

namespace delf::testing {

/// Figures, 30 x 20 blocks each, as test_golden_figures.cpp sees them: from a (white) to z (dark).
inline const std::array<std::pair<std::string, std::string>, 5> golden_figures{{
    {"breather/figures/spacetime.png",
     "aaaaaaaaaaaaaaaaaaaaaaaaabeeaa\n"
     "aagefffffffghmqlhgfffffffevaaa\n"
     "aaabcccccccelzzzkdcccccccbzaaa\n"
     "aaebcccccccdiwzuhdcccccccbzcca\n"
     "aaabcccccccekzzzjdcccccccbxcba\n"
     "aaebcccccccdjzzyidcccccccbsaaa\n"
     "aaabcccccccdjyzwidcccccccbodba\n"
     "aaebcccccccekzzzjdcccccccbkaaa\n"
     "aaabcccccccdiwzthdcccccccbfaaa\n"
     "baebcccccccelzzzkdcccccccbcdaa\n"
     "daabcccccccdhtzrgdcccccccbgaaa\n"
     "cadbcccccccemzzzkecccccccblaaa\n"
     "aaabcccccccdgrzqfccccccccbpaea\n"
     "aafccccccccemzzzlecccccccbtaaa\n"
     "aaabcccccccdgrzpfccccccccbwaaa\n"
     "aadbcccccccenzzzlecccccccbzcba\n"
     "aaabcccccccdgrzpfccccccccbzaaa\n"
     "aadefffffffhlyzwkgfffffffdtaaa\n"
     "aaacaacacbadaaeaacacbadbaeaaaa\n"
     "aaaaaaaaaaaaaegbaaaaaaaaaaaaaa\n"},
    {"breather/figures/waveforms.png",
     "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaa\n"
     "aaadcaaaaaaabfeaaaaaadfdaaaaaa\n"
     "aaeaaaaeaaaaeaaaaaaaaaaaaaaaaa\n"
     "abcaaaddaaaaeaaaaaaaaaaaaaaaaa\n"
     "daebaaeeaaaafabbcaaaabaaaaaaaa\n"
     "cadccdcaeccbgcddddccaccdcbdcca\n"
     "bcdaaaaaaaaafaaaaaaaaaaaddaaaa\n"
     "abdaaaaaaaaaeaaaaaaaaaaaddaaaa\n"
     "acedeeeeeeebiefeeeeeaeeegheeea\n"
     "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaa\n"
     "aacfeeaaaaaagfhaaaaaaffaaaaaaa\n"
     "aadaaaaaaaaaeaabeaaaaaaaaaaaaa\n"
     "aacaaaaaaaaaeaaddaaaaaaadeaaaa\n"
     "fadbaaaaaaaafabfdcaaabaafebaaa\n"
     "caecccfeddcbgcdaacccacceaadcca\n"
     "acbaaaaeaaaafaaaaaaaaaaaaaaaaa\n"
     "abdaaaaaaaaafaaaaaaaaaaaaaaaaa\n"
     "adfddddddedcgdededddaddddddddb\n"
     "aaabaeacadaedadaeaeaebccccadae\n"
     "aaaaaaefbaaaaaaffbaaaaaafdaaaa\n"},
    {"breather/figures/energy.png",
     "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaa\n"
     "aaedddcdceecedddcdcedceddddeca\n"
     "aaaabbabbbcacabbacbbbabaccabaa\n"
     "aaeacbabcaacbabcacbaabcacbacca\n"
     "aababdadbaaadadbaacaadcaacadca\n"
     "aabadaaacaadbaacadbaaacadcaaba\n"
     "dafaadadaaaadadaaadaadbaadacba\n"
     "caaadaaadaadaaadacaaabeacaabda\n"
     "eacabbabbaafaabbaddaaaaaddaaaa\n"
     "faaaadaeaaadaaeaaadaafaaacaafa\n"
     "acdadaaadaacaaadaacaafaabaaaga\n"
     "eaaacaaacaafaaacaagaabaaecaaaa\n"
     "cadaaeaadaaeaadaaaeaadaaadaada\n"
     "dacacbaaeaacaacdaabaagaaaaaaha\n"
     "ccbadaaadaaeaaacaafaacaaebaaba\n"
     "aacaaeaaeaaeaadaaaeaadaabdaada\n"
     "aaaadaaaeaadaabdaadaaeaacaaaea\n"
     "acddedddeedeededddeddeedeeddea\n"
     "aaabaabaadaabcaccaaeaafaadaabc\n"
     "aaaaaaaaaaaaaaaedaaaaaaaaaaaaa\n"},
    {"kepler/figures/orbit.png",
     "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaa\n"
     "aahaaaaaaaaaabdccebdccaaaaaaaa\n"
     "aaaaaaaaaaabcbaaaaaaabbbaaaaaa\n"
     "aagaaaaaaacbaaaaaaaaaaaacaaaaa\n"
     "aaaaaaaaabaaaaaaaaaaaaaaadaaaa\n"
     "aagaaaaabaaaaaaaaaaaaaaaaacaaa\n"
     "aaaaaaaabaaaaaaaaaaaaaaaaaabaa\n"
     "aahaaaacaaaaaaaaaaaaaaaaaaadaa\n"
     "aaaaaaacaaaaaaaaaaaaaaaaaaabaa\n"
     "eccaaaabaaaaaaaaaaaaaaaaaaadaa\n"
     "aaaaaaacaaaaaaaaaaaaaaaaaaabaa\n"
     "abeaaaabaaaaaaaaaaaaaaaaaaacaa\n"
     "aaaaaaaabaaaaaaaaaaaaaaaaabbaa\n"
     "aagaaaaacaaaaaaaaaaaaaaaaacaaa\n"
     "aaaaaaaaadaaaaaaaaaaaaaaacaaaa\n"
     "abfaaaaaaacaaaaaaaaaaaaacaaaaa\n"
     "aaaaaaaaaaabbbaaaaaaabbbaaaaaa\n"
     "abgddddddddddegffeffgeddddddda\n"
     "aaaeaaabdaaaaeaaaafbaaacaaaacb\n"
     "aaaaaaaaaaaaaaaccaaaaaaaaaaaaa\n"},
    {"kepler/figures/trajectory.png",
     "aaaaaaaaaaaaaaaaaaaaaaaaaaacba\n"
     "aadbaaaaaaaaaaaaaaaaaaaaaaaaaa\n"
     "aaaabcaaaaaaaaaaacbaaaaaaaaaaa\n"
     "aaabbacbaaaaaaaabaabaaaaaaaaba\n"
     "aaedaaacaaaaaaacbaabbaaaaaabda\n"
     "aaadaaaabaaaaaadbaaabaaaaaacda\n"
     "aadcbaaaabaaaacbcaaaabaaaaacda\n"
     "aaaacaaaaaaaaacbcaaaaacaaabcaa\n"
     "baaacaaaaabaaabbabaaaaabaabbaa\n"
     "fceabaaaaaacabbbacaaaaabbabbaa\n"
     "gaaaacaaaaaabccaacaaaaaabccbaa\n"
     "gaaaacaaaaaaacaaaacaaaaaacaaaa\n"
     "aadaaacaaaaacaaaaacaaaaaabaaaa\n"
     "aaaaaabaaaabbaaaaaacaaaacaaaaa\n"
     "acdaaaacaaacaaaaaaabbaadaaaaaa\n"
     "aaaaaaaabcbaaaaaaaaabccaaaaaaa\n"
     "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaa\n"
     "aadddddedddedddddddedddeddddda\n"
     "aaabaaacaaaaaaabaabcaabcaacbaa\n"
     "aaaaaaaaaaaaaaaedaaaaaaaaaaaaa\n"},
}};

}  // namespace delf::testing
