// Batches made of the reference: what a sweep must take as it is, and what it must survive.
#pragma once

#include <vector>

#include "mbs/implementation.hpp"

namespace mbs::test {

/// "sound": lanes that are the reference each, four at once; "lost_lane": lane 1 of each batch is
/// NaN from step 40 on; "failed_lane": its tangent cannot be factorized at step 40; "throws": at
/// step 40, all lanes; "unsupported": refuses every batch; "leaks": a lane that is lost is all
/// lanes' state; "mixes": every lane has the numbers of lane 0; "mixes_dampings" and the like: of
/// these alone. Alone, each is the reference.
std::vector<Variant> batches();

/// Steps that lanes of any of them have done in this process.
long batch_steps();

}  // namespace mbs::test
