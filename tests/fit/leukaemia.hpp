#pragma once

#include <vector>

#include "clog/fit/clogging_length.hpp"

namespace clog::fit {

/// Remission times [weeks] of the two arms of the 6-MP trial (Freireich et al., Blood 21, 699 (1963)), the
/// common example of survival analysis. Twelve of the 21 treated patients are censored, and none of the
/// patients with placebo.
inline const std::vector<Observation> leukaemia_treated = {
    {6, true},   {6, true},   {6, true},   {6, false},  {7, true},   {9, false},  {10, true},
    {10, false}, {11, false}, {13, true},  {16, true},  {17, false}, {19, false}, {20, false},
    {22, true},  {23, true},  {25, false}, {32, false}, {32, false}, {34, false}, {35, false}};
inline const std::vector<Observation> leukaemia_placebo = {
    {1, true},  {1, true},  {2, true},  {2, true},  {3, true},  {4, true},  {4, true},
    {5, true},  {5, true},  {8, true},  {8, true},  {8, true},  {8, true},  {11, true},
    {11, true}, {12, true}, {12, true}, {15, true}, {17, true}, {22, true}, {23, true}};

}  // namespace clog::fit
