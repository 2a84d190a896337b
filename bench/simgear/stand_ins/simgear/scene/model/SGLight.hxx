// SPDX-License-Identifier: MIT
// In the place of SimGear's header of this name: lights and settings with the members that its clustered shading reads.
// SimGear's own are read from files, by far more code than is measured here.
#pragma once

#include <osg/Node>
#include <osg/Vec3>
#include <osg/Vec4>

#include <map>
#include <memory>
#include <string>
#include <vector>

class SGLight : public osg::Node {
public:
    enum Type { POINT, SPOT };
    Type type = POINT;
    float range = 0, cutoff = 180;

    Type getType() const { return type; }
    int getPriority() const { return 0; }
    float getRange() const { return range; }
    float getSpotCutoff() const { return cutoff; }
    float getSpotExponent() const { return 1; }
    float getConstantAttenuation() const { return 1; }
    float getLinearAttenuation() const { return 0; }
    float getQuadraticAttenuation() const { return 1; }
    float getIntensity() const { return 1; }
    osg::Vec3 getColor() const { return {1, 1, 1}; }
    osg::Vec4f getAmbient() const { return {0, 0, 0, 1}; }
    osg::Vec4f getDiffuse() const { return {1, 1, 1, 1}; }
    osg::Vec4f getSpecular() const { return {1, 1, 1, 1}; }
};
using SGLightList = std::vector<osg::ref_ptr<SGLight>>;

class SGPropertyNode {
public:
    std::map<std::string, SGPropertyNode> children;
    int value = 0;

    const SGPropertyNode* getNode(const std::string& name) const {
        const auto found = children.find(name);
        return found == children.end() ? nullptr : &found->second;
    }
    int getIntValue() const { return value; }
    int getIntValue(const std::string& name, int otherwise) const {
        const SGPropertyNode* child = getNode(name);
        return child ? child->value : otherwise;
    }
    bool getBoolValue(const std::string& name, bool otherwise) const {
        return getIntValue(name, otherwise) != 0;
    }
    std::string getStringValue() const { return std::to_string(value); }
};
