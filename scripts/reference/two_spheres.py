#!/usr/bin/python3
"""Two equal spheres in Stokes flow that slide past each other or turn, exactly: prints tests/reference/06_lubrication_pairs.csv.

Lamb's exterior solutions of azimuthal order one about both centres, related by the mirror between them; boundary values met by least squares on
the surface of one sphere. Axis z through both centres, radius 1, viscosity 1.
"""

import argparse

import numpy as np


def legendre(n_max, x, m):
    # P_n^m without the Condon-Shortley sign
    s=np.sqrt(1-x*x); P=np.zeros((n_max+2,len(x)))
    pmm=np.ones_like(x)
    for k in range(1,m+1): pmm=pmm*(2*k-1)*s
    P[m]=pmm; P[m+1]=x*(2*m+1)*pmm
    for n in range(m+2,n_max+2): P[n]=((2*n-1)*x*P[n-1]-(n+m-1)*P[n-2])/(n-m)
    return P
def harmonics(N,r,th):
    x=np.cos(th); P=legendre(N+1,x,1); s=np.sin(th)
    H=[];dHr=[];dHt=[];Hs=[]
    for n in range(1,N+1):
        f=r**-(n+1.)
        dP=(n*x*P[n]-(n+1)*P[n-1])/s   # dP_n^m/dtheta * ... : sin th dP/dth = n x P_n -(n+m)P_{n-1}
        H.append(f*P[n]); dHr.append(-(n+1)*f*P[n]/r); dHt.append(f*dP/r); Hs.append(f*P[n]/s/r)
    return map(np.array,(H,dHr,dHt,Hs))
def basis(N,rho,z):
    # at points (rho,z) in phi: components (u_r cos, u_th cos, u_phi sin) about sphere at origin -> cylindrical amplitude (u_rho,u_phi,u_z)
    r=np.hypot(rho,z); th=np.arctan2(rho,z)
    H,Hr,Ht,Hs=harmonics(N,r,th)
    cols=[]
    st,ct=np.sin(th),np.cos(th)
    def cyl(ur,ut,up): return np.array([ur*st+ut*ct,up,ur*ct-ut*st])
    for i in range(N):
        n=i+1
        # grad phi, phi=H cos(phi): u_phi = -H/(r sin) sin
        cols.append(cyl(Hr[i],Ht[i],-Hs[i]))
        # curl(r chi) = grad chi x r ; chi = H sin(phi): grad chi=(.., Ht sin, Hs cos) ; x r e_r: (t,p) x r: u_th = r*gphi, u_phi=-r*gth
        cols.append(cyl(0*Hr[i],r*Hs[i],-r*Ht[i]))
        k=-(n+1)
        a=(k+3)/(2*(k+1)*(2*k+3)); b=-k/((k+1)*(2*k+3))
        cols.append(cyl(a*r*r*Hr[i]+b*r*H[i],a*r*r*Ht[i],-a*r*r*Hs[i]))
    return np.array(cols) # (3N, 3, pts)
def solve(xi,mode,N=None):
    d=2+xi; N=N or int(min(140,max(20,14/np.sqrt(xi))))
    M=3*N; t=(np.arange(M)+.5)*np.pi/M
    rho=np.sin(t);z=np.cos(t)
    # sphere 1 at -d/2 (surface points), sphere 2 at +d/2. mirror symmetry used: sphere 2 solution = sigma * mirror of sphere 1
    own=basis(N,rho,z)                       # from own centre
    other=basis(N,rho,d-z)                # mirrored coordinates: distance measured from the other centre, z flipped
    # mirrored flow about the other sphere: (u_rho,u_phi,u_z)-> (u_rho,u_phi,-u_z) times sigma
    sig={'slide':-1,'roll_same':-1,'roll_opposite':1}[mode]
    mir=other.copy(); mir[:,2]*=-1
    A=(own+sig*mir)
    one=np.ones_like(t)
    if mode == 'slide': bc=np.array([one,-one,0*one])       # unit velocity along x: u_rho=cos, u_phi=-sin
    else: bc=np.array([z,-z,-rho])           # rotation about y with W=1: u = y x r = (z,0,-x)
    w=np.sqrt(np.sin(t)+.02)
    Aw=(A*w).reshape(3*N,-1).T; bw=(bc*w).ravel()
    sc=np.sqrt((Aw**2).sum(0)); c,res,_,_=np.linalg.lstsq(Aw/sc,bw,rcond=1e-15); c=c/sc
    err=np.abs((A*c[:,None,None]).sum(0)-bc).max()
    # force = -4 pi grad(r^3 p_-2): p=c[2] H_1 cos = c (sin th cos phi)/r^2 -> F=-4 pi c x ; torque=-8 pi mu grad(r^3 chi_-2), chi=c[1] sin th sin phi/r^2 -> y
    return -4*np.pi*c[2]/(6*np.pi), -8*np.pi*c[1]/(8*np.pi), err
if __name__ == '__main__':
    argparse.ArgumentParser(description=__doc__).parse_args()
    print('# Two equal spheres of radius a, surface gap h, exact (multipole collocation, scripts/reference/two_spheres.py). slide: tangential velocities U and -U, no rotation:')
    print('# F/(6 pi mu a U) against it. roll_same, roll_opposite: spins W and W (or W and -W) about parallel axes across the line of centres: T/(8 pi mu a^3 W) against it.')
    print('# residual: of the boundary values. As h -> 0: ln(a/h)/3 + 1.272, ln(a/h)/4 + 0.675, 0.15 ln(a/h) + 0.730 (Jeffrey & Onishi 1984).')
    print('h_over_a,slide,roll_same,roll_opposite,residual')
    for xi in (0.01, 0.02, 0.03, 0.05, 0.075, 0.1, 0.15, 0.2, 0.3, 0.5, 0.75, 1, 1.5, 2, 4):
        slide, same, opposite = (solve(xi, mode) for mode in ('slide', 'roll_same', 'roll_opposite'))
        print('%g,%.6f,%.6f,%.6f,%.0e' % (xi, -slide[0], -same[1], -opposite[1], max(slide[2], same[2], opposite[2])))
