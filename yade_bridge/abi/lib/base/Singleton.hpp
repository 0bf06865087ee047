#pragma once

template <class T>
class Singleton {
public:
    static T& instance();  // instantiated in libyade
};
