"""The BSDF of one wide interface, applied to binned arrivals: the parts of `goniosim.engine.estimators.operator`.

A random walk only bins the light that arrives at the interface. Then all cells see all arrivals: the BSDF of an
isotropic interface is a convolution in azimuth, hence a product of matrices for each coefficient of a cosine series.
"""
