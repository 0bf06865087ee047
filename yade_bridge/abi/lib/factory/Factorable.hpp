#pragma once

#include <boost/enable_shared_from_this.hpp>

#include <string>

namespace yade {

class Factorable : public boost::enable_shared_from_this<Factorable> {
public:
    Factorable() {}
    virtual ~Factorable();
    virtual std::string getBaseClassName(unsigned int i = 0) const;
    virtual int getBaseClassNumber() const;
    virtual std::string getClassName() const;
};

}  // namespace yade
