// The error of a start that its constraints do not allow.
#pragma once

#include "usage_error.hpp"

namespace mbs {

/// A start that cannot be moved onto its constraints.
class NotAssembled : public UsageError {
  using UsageError::UsageError;
};

}  // namespace mbs
