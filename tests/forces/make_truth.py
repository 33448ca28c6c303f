"""Truth of the scenes in this folder, from 45-digit closed forms (mpmath): Kepler by his equation
and f and g, a pair on a spring along a line by its two exponentials, the figure eight by its own
Taylor series of order 40. Shares no code with carom. Anew: python3 make_truth.py
"""
import mpmath as mp, os
from mpmath import mpf
mp.mp.dps=45
OUT=os.path.dirname(os.path.abspath(__file__))
def write(name, toml, times, states, names):
    os.makedirs(f'{OUT}/{name}',exist_ok=True)
    open(f'{OUT}/{name}/scene.toml','w').write(toml)
    with open(f'{OUT}/{name}/truth.csv','w') as f:
        f.write('time,body,x,y,z,vx,vy,vz\n')
        for t,st in zip(times,states):
            for n,(x,v) in zip(names,st):
                f.write(f'{mp.nstr(mpf(t),20)},{n},'+','.join(mp.nstr(c,25) for c in list(x)+list(v))+'\n')
    open(f'{OUT}/{name}/events.csv','w').write('time,kind,a,b,impulse\n')
def body(n,m,r,x,v):
    return f'[[bodies]]\nname = "{n}"\nmass = {m!r}\nradius = {r!r}\nposition = {[float(c) for c in x]}\nvelocity = {[float(c) for c in v]}\n\n'
# universal kepler from arbitrary double state by f,g functions
def kepler(name, G, m1, m2, x1, v1, x2, v2, dur, every):
    x1,v1,x2,v2=[ [mpf(c) for c in a] for a in (x1,v1,x2,v2)]
    mu=mpf(G)*(mpf(m1)+mpf(m2)); M=mpf(m1)+mpf(m2)
    d=[b-a for a,b in zip(x1,x2)]; w=[b-a for a,b in zip(v1,v2)]
    r0=mp.sqrt(sum(c*c for c in d)); vv=sum(c*c for c in w); a=1/(2/r0-vv/mu)
    n=mp.sqrt(mu/a**3); ecosE=1-r0/a; esinE=sum(p*q for p,q in zip(d,w))/mp.sqrt(mu*a)
    e=mp.sqrt(ecosE**2+esinE**2); E0=mp.atan2(esinE,ecosE); M0=E0-esinE
    X=[(mpf(m1)*p+mpf(m2)*q)/M for p,q in zip(x1,x2)]; V=[(mpf(m1)*p+mpf(m2)*q)/M for p,q in zip(v1,v2)]
    print(name,'e',mp.nstr(e,8),'period',mp.nstr(2*mp.pi/n,8))
    N=round(dur/every); times=[];st=[]
    for i in range(N+1):
        t=mpf(i*every); Mt=M0+n*t
        k=mp.floor((Mt+mp.pi)/(2*mp.pi)); Mr=Mt-2*mp.pi*k
        f=lambda E:E-e*mp.sin(E)-Mr
        lo,hi=-mp.pi-1,mp.pi+1
        for _ in range(60):
            mid=(lo+hi)/2
            if f(mid)>0: hi=mid
            else: lo=mid
        E=(lo+hi)/2
        for _ in range(6): E-=f(E)/(1-e*mp.cos(E))
        E+=2*mp.pi*k
        dE=E-E0
        r=a*(1-e*mp.cos(E))
        ff=1-a/r0*(1-mp.cos(dE)); g=t-(dE-mp.sin(dE))/n
        fd=-mp.sqrt(mu*a)/(r*r0)*mp.sin(dE); gd=1-a/r*(1-mp.cos(dE))
        D=[ff*p+g*q for p,q in zip(d,w)]; W=[fd*p+gd*q for p,q in zip(d,w)]
        c=[p+q*t for p,q in zip(X,V)]
        st.append([([p-mpf(m2)/M*q for p,q in zip(c,D)],[p-mpf(m2)/M*q for p,q in zip(V,W)]),
                   ([p+mpf(m1)/M*q for p,q in zip(c,D)],[p+mpf(m1)/M*q for p,q in zip(V,W)])])
        times.append(t)
    toml=f'name = "{name}"\nduration = {dur!r}\nsample_every = {every!r}\n[units]\nlength = "none"\n'
    toml+=body('a',m1,1e-3,x1,v1)+body('b',m2,1e-3,x2,v2)+f'[effects.attraction]\nconstant = {G!r}\n'
    write(name,toml,times,st,['a','b'])
# e=.99, a=1, mu=8 ; start at apo: r=1.99, v=sqrt(mu*(2/1.99-1))
import math
def ell(name,e,G,m1,m2,periods,ns,peri,cm=(0.,0.,0.),vcm=(0,0,0)):
    mu=G*(m1+m2); r=(1-e) if peri else (1+e); v=math.sqrt(mu*(2/r-1))
    T=2*math.pi/math.sqrt(mu); every=math.floor(T*periods/ns*1024)/1024
    u=(2/3,1/3,2/3); w=(-1/3,-2/3,2/3)
    M=m1+m2
    x1=[c-m2/M*r*q for c,q in zip(cm,u)]; x2=[c+m1/M*r*q for c,q in zip(cm,u)]
    v1=[c-m2/M*v*q for c,q in zip(vcm,w)]; v2=[c+m1/M*v*q for c,q in zip(vcm,w)]
    kepler(name,G,m1,m2,x1,v1,x2,v2,every*ns,every)
ell('kepler-e099',.99,2.0,3.0,1.0,3,60,False)
ell('kepler-e099-peri',.99,2.0,3.0,1.0,3,60,True,(1.,2.,3.),(.1,.2,-.1))
ell('kepler-mass',.5,1e-6,1e9,1.0,3,64,False)
ell('kepler-e09-100',.9,5.5,2.0,3.0,100,100,True)
# springs on a line, equal-or-not masses: pair linear
def spring(name,m1,m2,k,c,l0,x1,v1,x2,v2,dur,every):
    mu=mpf(m1)*mpf(m2)/(mpf(m1)+mpf(m2)); M=mpf(m1)+mpf(m2)
    u=(mpf(x2[0])-mpf(x1[0])); u_=u # along x axis
    q0=u-mpf(l0); p0=mpf(v2[0])-mpf(v1[0])
    a=mpf(c)/(2*mu); om2=mpf(k)/mu
    disc=a*a-om2
    N=round(dur/every); times=[];st=[]
    X=(mpf(m1)*mpf(x1[0])+mpf(m2)*mpf(x2[0]))/M; V=(mpf(m1)*mpf(v1[0])+mpf(m2)*mpf(v2[0]))/M
    for i in range(N+1):
        t=mpf(i*every)
        if disc>0:
            s=mp.sqrt(disc); l1=-om2/(a+s); l2=-a-s
            B=(p0-l1*q0)/(l2-l1); A=q0-B
            q=A*mp.e**(l1*t)+B*mp.e**(l2*t); p=A*l1*mp.e**(l1*t)+B*l2*mp.e**(l2*t)
        else:
            w=mp.sqrt(-disc); A=q0; B=(p0+a*q0)/w
            ex=mp.e**(-a*t); cs,sn=mp.cos(w*t),mp.sin(w*t)
            q=ex*(A*cs+B*sn); p=ex*((-a*A+w*B)*cs+(-a*B-w*A)*sn)
        d=q+mpf(l0); z=mpf(0)
        c0=X+V*t
        st.append([([c0-mpf(m2)/M*d,mpf(x1[1]),z],[V-mpf(m2)/M*p,z,z]),([c0+mpf(m1)/M*d,mpf(x1[1]),z],[V+mpf(m1)/M*p,z,z])]); times.append(t)
    toml=f'name = "{name}"\nduration = {dur!r}\nsample_every = {every!r}\n'
    toml+=body('a',m1,.1,x1,v1)+body('b',m2,.1,x2,v2)+f'[[effects.springs]]\nbetween = ["a","b"]\nstiffness = {k!r}\nrest_length = {l0!r}\ndamping = {c!r}\n'
    write(name,toml,times,st,['a','b'])
spring('stiff-1e4',1.0,2.0,1e4,3.0,1.2,[-.7,.5,0],[.3,0,0],[.8,.5,0],[-.2,0,0],4.0,.0625)
spring('stiff-1e6',1.0,2.0,1e6,0.0,1.2,[-.6,.5,0],[.3,0,0],[.61,.5,0],[-.2,0,0],4.0,.0625)
spring('over-1e4',1.0,2.0,1e4,1e4,1.2,[-.7,.5,0],[.3,0,0],[.8,.5,0],[-.2,0,0],4.0,.0625)
spring('over-1e6',1.0,2.0,1e6,1e5,1.2,[-.7,.5,0],[.3,0,0],[.8,.5,0],[-.2,0,0],4.0,.0625)
# figure eight by Taylor at 45 digits
def nbody(name,G,ms,xs,vs,dur,every,order=40):
    ms=[mpf(m) for m in ms]; n=len(ms)
    x=[[mpf(c) for c in a] for a in xs]; v=[[mpf(c) for c in a] for a in vs]
    def series(x,v):
        X=[[ [c] for c in a] for a in x]; V=[[[c] for c in a] for a in v]
        S={};Q={};D={}
        for k in range(order):
            A=[[mpf(0)]*3 for _ in range(n)]
            for i in range(n):
                for j in range(i+1,n):
                    if k==0: D[i,j]=[[],[],[]];S[i,j]=[];Q[i,j]=[]
                    d=D[i,j]
                    for c in range(3): d[c].append(X[j][c][k]-X[i][c][k])
                    S[i,j].append(mp.fsum(d[c][l]*d[c][k-l] for c in range(3) for l in range(k+1)))
                    s=S[i,j];q=Q[i,j]
                    if k==0: q.append(s[0]**mpf(-1.5))
                    else: q.append(mp.fsum((mpf(-1.5)*(k-l)-l)*s[k-l]*q[l] for l in range(k))/(k*s[0]))
                    for c in range(3):
                        f=mp.fsum(q[l]*d[c][k-l] for l in range(k+1))
                        A[i][c]+=mpf(G)*ms[j]*f; A[j][c]-=mpf(G)*ms[i]*f
            for i in range(n):
                for c in range(3):
                    X[i][c].append(V[i][c][k]/(k+1)); V[i][c].append(A[i][c]/(k+1))
        return X,V
    N=round(dur/every); times=[mpf(0)];st=[[(list(a),list(b)) for a,b in zip(x,v)]]
    sub=8
    for i in range(1,N+1):
        h=mpf(every)/sub
        for _ in range(sub):
            X,V=series(x,v)
            last=max(abs(X[i][c][-1]) for i in range(n) for c in range(3))*h**order
            assert last<mpf(10)**-34,mp.nstr(last)
            x=[[mp.polyval(X[i][c][::-1],h) for c in range(3)] for i in range(n)]
            v=[[mp.polyval(V[i][c][::-1],h) for c in range(3)] for i in range(n)]
        times.append(mpf(i*every)); st.append([(list(a),list(b)) for a,b in zip(x,v)])
    toml=f'name = "{name}"\nduration = {dur!r}\nsample_every = {every!r}\n[units]\nlength = "none"\n'
    for i in range(n): toml+=body('abc'[i],float(ms[i]),.01,xs[i],vs[i])
    toml+=f'[effects.attraction]\nconstant = {G!r}\n'
    write(name,toml,times,st,list('abc')[:n])
p=(0.97000436,-0.24308753); q=(0.93240737,0.86473146)
nbody('figure-eight',1.0,[1,1,1],[[p[0],p[1],0.],[-p[0],-p[1],0.],[0.,0.,0.]],[[q[0]/2,q[1]/2,0.],[q[0]/2,q[1]/2,0.],[-q[0],-q[1],0.]],20.0,.25)
