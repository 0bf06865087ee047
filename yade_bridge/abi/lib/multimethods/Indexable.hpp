#pragma once

namespace yade {

/// Only its place in State and Shape matters here: one pointer to virtual functions.
class Indexable {
public:
    virtual ~Indexable();
};

}  // namespace yade
